import * as THREE from "three";

const VEHICLE = new THREE.MeshStandardMaterial({ color: 0x8c9096 });
const PERSON = new THREE.MeshStandardMaterial({ color: 0xc4782c });
const PEDESTRIAN = 3; // simconsole_msgs/RoadUser
const BOX = new THREE.BoxGeometry(1, 1, 1);
const LAMPS = { red: 0xe82c24, amber: 0xf0a818, green: 0x2ece6a };
/** Which lamps shine in each state of a signal's link (SAE J2735). */
const SHINING = {
  2: ["red"],
  3: ["red"],
  4: ["red", "amber"],
  5: ["green"],
  6: ["green"],
  7: ["amber"],
  8: ["amber"],
  9: ["amber"],
};

/** Everybody else on the road, as boxes, and the lamps of the traffic lights. */
export class Others {
  boxes = new Map();

  constructor(map) {
    this.map = map; // the frame in which they are told
  }

  /** Take /road_users: who is not in it any more has left. */
  takeUsers({ users }) {
    const told = new Set(users.map(({ id }) => id));
    for (const [id, box] of this.boxes)
      if (!told.has(id)) {
        box.removeFromParent();
        this.boxes.delete(id);
      }
    for (const user of users) this.place(user);
  }

  place({ id, kind, pose: { position, orientation }, size }) {
    let box = this.boxes.get(id);
    if (!box) {
      box = new THREE.Mesh(BOX, kind === PEDESTRIAN ? PERSON : VEHICLE);
      box.castShadow = true;
      this.boxes.set(id, box);
      this.map.add(box);
    }
    box.scale.set(size.x, size.y, size.z);
    box.position.set(position.x, position.y, position.z + size.z / 2); // told is the middle of the footprint
    box.quaternion.set(orientation.x, orientation.y, orientation.z, orientation.w);
  }

  /** Take /traffic_signals: light the lamps among `parts` that show a link of one of the signals. */
  takeSignals({ signals }, parts) {
    const states = new Map(signals.map(({ id, states }) => [id, states]));
    for (const part of parts) {
      const shown = states.get(part.userData.signal);
      if (shown === undefined) continue; // no lamp, or too far away to be told of
      const name = part.name.split("_").at(-1);
      const on = (SHINING[shown[part.userData.link]] ?? []).includes(name);
      part.traverse((mesh) => mesh.isMesh && mesh.material.emissive.set(on ? LAMPS[name] : 0));
    }
  }
}
