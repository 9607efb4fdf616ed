import { Hud } from "./hud.js";
import { Motion } from "./motion.js";
import { subscribe } from "./rosbridge.js";
import { Stage } from "./stage.js";

const query = new URLSearchParams(location.search);
const host = query.get("host") ?? "localhost:9090";
const scheme = query.has("tls") ? "wss" : "ws";
const token = query.has("token") ? `/?token=${encodeURIComponent(query.get("token"))}` : "";
const prefix = query.get("namespace") ?? "";

const clock = () => performance.now() / 1000;
const stage = new Stage(document.getElementById("picture"), {
  camera: query.get("camera") ?? "driver",
  shadows: query.has("shadows") ? query.get("shadows") !== "0" : undefined,
});
const motion = new Motion();
const hud = new Hud();
const state = { connection: "connecting", frames: 0, drawn: null };

subscribe(
  `${scheme}://${host}${token}`,
  {
    [`${prefix}/view/scene`]: (message) => stage.load(message),
    [`${prefix}/view/poses`]: (message) => motion.take(message, clock()),
    [`${prefix}/view/hud`]: (message) => hud.take(message, clock()),
  },
  (connection) => (state.connection = connection),
);

function draw() {
  const now = clock();
  state.drawn = motion.at(now);
  if (state.drawn) stage.move(state.drawn.frames);
  hud.draw(now);
  for (const [name, on] of Object.entries(hud.lamps)) stage.show(name, on);
  stage.draw();
  state.frames += 1;
  requestAnimationFrame(draw);
}
draw();

/** What the page shows, for tests and for the curious: `view()` in the browser's console. */
globalThis.view = () => ({
  connection: state.connection,
  frames: state.frames,
  parts: stage.parts.map((part) => part.name),
  hud: { ...hud.text, stamp: hud.stamp },
  time: state.drawn?.time,
  older: state.drawn?.older,
  newer: state.drawn?.newer,
  poses: Object.fromEntries(
    [...(state.drawn?.frames.keys() ?? [])].map((name) => {
      const { position, quaternion } = stage.frame(name, "map");
      return [name, [...position.toArray(), ...quaternion.toArray()]];
    }),
  ),
});
