import { Quaternion, Vector3 } from "three";
import { seconds } from "./rosbridge.js";

const FORGET_S = 0.0002; // the fastest message seen counts a little less with each that comes
const LEAP_S = 0.25; // later than this: time stood, or began anew

/** The two newest poses of every frame, and where they are now: one period ago, so that nothing is guessed. */
export class Motion {
  older = null;
  newer = null;
  delay = null; // arrival by this machine's clock minus stamp, of the fastest message lately

  /** Take a message of /view/poses that arrived at `now`, in seconds of this machine's clock. */
  take(message, now) {
    const stamp = seconds(message.transforms[0].header.stamp);
    const frames = new Map(message.transforms.map((one) => [one.child_frame_id, frame(one)]));
    const delay = now - stamp;
    const leap = this.newer === null || stamp <= this.newer.stamp || Math.abs(delay - this.delay) > LEAP_S;
    this.delay = leap ? delay : Math.min(delay, this.delay + FORGET_S);
    this.newer = { stamp, frames };
    this.older = leap ? this.newer : this.last;
    this.last = this.newer;
  }

  /** Return what to draw at `now`: simulated time, the stamps around it, frames; null before the first message. */
  at(now) {
    if (this.newer === null) return null;
    const { older, newer } = this;
    const period = newer.stamp - older.stamp;
    const time = Math.min(newer.stamp, Math.max(older.stamp, now - this.delay - period));
    const share = period > 0 ? (time - older.stamp) / period : 1;
    const frames = new Map();
    for (const [name, to] of newer.frames) {
      const from = older.frames.get(name) ?? to;
      frames.set(name, {
        parent: to.parent,
        place: from.place.clone().lerp(to.place, share),
        turn: from.turn.clone().slerp(to.turn, share), // the short way round
      });
    }
    return { time, older: older.stamp, newer: newer.stamp, frames };
  }
}

function frame({ header, transform: { translation, rotation } }) {
  return {
    parent: header.frame_id,
    place: new Vector3(translation.x, translation.y, translation.z),
    turn: new Quaternion(rotation.x, rotation.y, rotation.z, rotation.w),
  };
}
