import { seconds } from "./rosbridge.js";

const STALE_S = 0.5;
const DANGER = 6; // alerts from "the car is stopping" on
const TAKE_OVER = [5, 7];
const BLINK_S = 0.67;

/** The driver's display, from simconsole_msgs/Hud. */
export class Hud {
  message = null;
  arrived = -Infinity;
  text = {};
  lamps = {}; // those of the car: parts of its model, shown while they are on

  take(message, now) {
    this.message = message;
    this.arrived = now;
  }

  draw(now) {
    const told = this.message;
    const paused = told?.mode_words === "PAUSED"; // then nothing comes, and nothing is wrong
    const stale = told === null || (now - this.arrived > STALE_S && !paused);
    document.getElementById("hud").classList.toggle("stale", stale);
    if (stale) return this.say({ speed: "–", gear: "–", mode: "NO DATA", reason: "", authority: "", alert: "", limit: "", turn: "" });
    const count = TAKE_OVER.includes(told.alert) ? ` ${Math.ceil(told.takeover_remaining)}` : "";
    this.stamp = seconds(told.header.stamp);
    this.say({
      speed: String(told.shown_speed),
      gear: (told.automatic ? "A " : "") + told.gear,
      mode: told.mode_words,
      reason: told.todo_words || told.reason_words,
      authority: steers(told),
      limit: told.speed_limit > 0 ? `limit ${Math.round(3.6 * told.speed_limit)}` : "",
      turn: nextTurn(told),
      alert: told.alert_words + count,
    });
    document.getElementById("alert").classList.toggle("danger", told.alert >= DANGER);
    const lit = seconds(told.header.stamp) % BLINK_S < 0.5 * BLINK_S;
    const left = lit && (told.hazard_lights || told.turn_indicators > 0);
    const right = lit && (told.hazard_lights || told.turn_indicators < 0);
    this.lamp("left", left);
    this.lamp("right", right);
    this.lamps = { brake_lamps: told.brake > 0, left_indicators: left, right_indicators: right };
  }

  say(text) {
    this.text = text;
    for (const [name, value] of Object.entries(text)) document.getElementById(name).textContent = value;
  }

  lamp(name, on) {
    document.getElementById(name).classList.toggle("on", on);
  }
}

/** Where the route turns next; nothing without a route. */
function nextTurn({ turn_distance: distance, turn_angle: angle, turn_exit: exit, turn_ends: ends }) {
  if (distance < 0) return "";
  const far = distance < 1000 ? `${10 * Math.round(distance / 10)} m` : `${(distance / 1000).toFixed(1)} km`;
  if (ends) return `\u2691 ${far}`;
  const arrow = Math.abs(angle) < 0.3 ? "\u2191" : angle > 0 ? "\u21b0" : "\u21b1";
  return exit > 0 ? `exit ${exit} ${arrow} ${far}` : `${arrow} ${far}`;
}

/** Who steers, and with what share where it is not all. */
function steers({ remote_lateral: share, other_side: other }) {
  if (share <= 0) return "DRIVER";
  return share < 1 ? `${other} ${Math.round(100 * share)} %` : other;
}
