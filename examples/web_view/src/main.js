import { Hud } from "./hud.js";
import { Motion } from "./motion.js";
import { Others } from "./others.js";
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
const others = new Others(stage.map);
const state = { connection: "connecting", frames: 0, drawn: null };

subscribe(
  `${scheme}://${host}${token}`,
  {
    [`${prefix}/view/scene`]: ["visualization_msgs/MarkerArray", (message) => stage.load(message)],
    [`${prefix}/view/poses`]: ["tf2_msgs/TFMessage", (message) => motion.take(message, clock())],
    [`${prefix}/view/hud`]: ["simconsole_msgs/Hud", (message) => hud.take(message, clock())],
    [`${prefix}/road_users`]: ["simconsole_msgs/RoadUsers", (message) => others.takeUsers(message)],
    [`${prefix}/traffic_signals`]: [
      "simconsole_msgs/TrafficSignals",
      (message) => others.takeSignals(message, stage.parts),
    ],
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
  others: others.boxes.size,
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
