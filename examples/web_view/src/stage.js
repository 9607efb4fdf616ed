import * as THREE from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";

const SKY = 0xa9c4dc;
const REACH_M = 900;

/** The scene, the sun, the camera, and what moves. Frames are ROS's (x forward, z up); three.js has y up. */
export class Stage {
  constructor(canvas, { camera = "driver", shadows }) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    const software = /swiftshader|llvmpipe|softpipe/i.test(rendererName(this.renderer));
    this.renderer.shadowMap.enabled = shadows ?? !software; // shadows cost a processor too much
    this.scene = new THREE.Scene();
    this.scene.background = new THREE.Color(SKY);
    this.scene.fog = new THREE.Fog(SKY, 150, REACH_M);
    this.map = new THREE.Group(); // the frame `map`
    this.map.rotation.x = -Math.PI / 2;
    this.scene.add(this.map, new THREE.HemisphereLight(0xdfeaf5, 0x6b7458, 1.6));
    this.frames = new Map([["map", this.map]]);
    this.sun = sunlight();
    this.map.add(this.sun, this.sun.target);
    this.camera = new THREE.PerspectiveCamera(50, 1, 0.1, 2 * REACH_M);
    this.kind = camera;
    this.parts = [];
  }

  /** Take /view/scene: each marker is a model in a frame. */
  async load({ markers }) {
    const models = await Promise.all(markers.map(({ mesh_file }) => parse(mesh_file.data)));
    for (const part of this.parts) part.removeFromParent(); // those of a drive before this one
    this.parts = [];
    for (const [index, model] of models.entries()) {
      const frame = this.frame(markers[index].header.frame_id, "map");
      const [root] = model.scene.children; // its rotation makes y point up: here the frame `map` has that
      Object.assign(frame.userData, root.userData);
      for (const part of [...root.children]) this.add(part, frame);
    }
    this.seat(this.frame("base_link", "map"));
  }

  add(part, frame) {
    this.frames.get(part.name)?.removeFromParent();
    this.frames.set(part.name, part); // some parts, as the wheels, are frames that move
    this.parts.push(part);
    frame.add(part);
    part.traverse((mesh) => {
      if (!mesh.isMesh) return;
      const { layer } = part.userData;
      mesh.castShadow = layer === undefined;
      mesh.receiveShadow = true;
      mesh.material = mesh.material.clone();
      mesh.material.side = THREE.DoubleSide;
      if (layer === undefined) return;
      // Layers lie in one plane: each counts as a little nearer than the one below it.
      Object.assign(mesh.material, { polygonOffset: true, polygonOffsetFactor: -layer, polygonOffsetUnits: -8 * layer });
      mesh.renderOrder = layer;
    });
  }

  seat(vehicle) {
    const inside = this.kind === "driver" && vehicle.getObjectByName("bonnet") !== undefined;
    for (const name of ["bonnet", "hand_wheel"]) this.show(name, inside);
    for (const name of ["body", "front_left_wheel", "front_right_wheel", "rear_left_wheel", "rear_right_wheel"])
      this.show(name, !inside);
    for (const name of ["brake_lamps", "left_indicators", "right_indicators"]) this.show(name, false);
    const scale = Math.min(1, Math.max(0.1, (vehicle.userData.length_m ?? 4) / 4)); // nearer behind a small robot
    const behind = new THREE.Vector3(-9, 0, 3.2).multiplyScalar(scale);
    const place = inside ? vehicle.getObjectByName("driver_eye").position : behind;
    this.camera.position.copy(place);
    const [right, up, back] = [new THREE.Vector3(0, -1, 0), new THREE.Vector3(0, 0, 1), new THREE.Vector3(-1, 0, 0)];
    this.camera.quaternion.setFromRotationMatrix(new THREE.Matrix4().makeBasis(right, up, back));
    if (!inside) this.camera.rotateX(-0.18); // down to the car
    vehicle.add(this.camera);
  }

  show(name, visible) {
    const part = this.frames.get(name);
    if (part) part.visible = visible;
  }

  /** Return the node of a frame, made where it is not known yet. */
  frame(name, parent) {
    if (!this.frames.has(name)) {
      const made = new THREE.Group();
      made.name = name;
      this.frames.set(name, made);
      this.frames.get(parent).add(made);
    }
    return this.frames.get(name);
  }

  move(frames) {
    for (const [name, { parent, place, turn }] of frames) {
      const node = this.frame(name, parent);
      node.position.copy(place);
      node.quaternion.copy(turn);
    }
    const car = frames.get("base_link");
    if (car) {
      this.sun.target.position.copy(car.place);
      this.sun.position.copy(car.place).add(new THREE.Vector3(-60, 40, 90));
    }
  }

  draw() {
    const { clientWidth: width, clientHeight: height } = this.renderer.domElement;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.renderer.render(this.scene, this.camera);
  }
}

function parse(base64) {
  const content = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
  return new GLTFLoader().parseAsync(content.buffer, "");
}

function sunlight() {
  const sun = new THREE.DirectionalLight(0xfff2dc, 2.4);
  sun.castShadow = true;
  sun.shadow.mapSize.set(2048, 2048);
  sun.shadow.bias = -0.001; // of its reach: faces do not shade themselves
  Object.assign(sun.shadow.camera, { left: -70, right: 70, top: 70, bottom: -70, near: 1, far: 300 });
  return sun;
}

function rendererName(renderer) {
  const gl = renderer.getContext();
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  return String(gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER));
}
