// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
/* global THREE */

const RAMP = [[168, 178, 196], [96, 146, 208], [46, 168, 158], [244, 190, 66], [222, 88, 62]];

/// Time of drawing a picture above which the following ones have fewer pixels.
const SLOW_MS = 100;
const LEAST_PIXEL_RATIO = 0.5;

/// Colour scale: maps 0 to 1 to [red, green, blue], each 0 to 1.
export function ramp(share) {
  const place = Math.min(Math.max(share, 0), 1) * (RAMP.length - 1);
  const left = Math.min(Math.floor(place), RAMP.length - 2);
  return RAMP[left].map((from, i) =>
    (from + (RAMP[left + 1][i] - from) * (place - left)) / 255);
}

/// Decodes the answer of /front (host_tools/spm_view/cut.hpp).
export function read_cut(buffer) {
  const [vertices, faces] = new Uint32Array(buffer, 0, 2);
  let at = 8;
  const take = (type, count) => {
    const array = new type(buffer, at, count);
    at += count * type.BYTES_PER_ELEMENT;
    return array;
  };
  return {
    faces,
    positions: take(Float32Array, 3 * vertices),
    corners: take(Uint32Array, 3 * faces),
    errors: take(Float32Array, faces),
    levels: take(Uint16Array, faces),
  };
}

/// Decodes the answer of /boxes, /loaded or /requested (host_tools/spm_view/cut.hpp) to line
/// ends.
export function read_boxes(buffer) {
  const count = new Uint32Array(buffer, 0, 1)[0];
  const ends = new Float32Array(buffer, 4, 6 * count);
  const lines = new Float32Array(72 * count);
  let at = 0;
  for (let box = 0; box < count; ++box) {
    for (let axis = 0; axis < 3; ++axis) {
      for (let edge = 0; edge < 4; ++edge) {
        for (let end = 0; end < 2; ++end) {
          const side = [0, 0, 0];
          side[axis] = end;
          side[(axis + 1) % 3] = edge & 1;
          side[(axis + 2) % 3] = edge >> 1;
          for (let i = 0; i < 3; ++i) {
            lines[at++] = ends[6 * box + 3 * side[i] + i];
          }
        }
      }
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(lines, 3));
  return { geometry, count };
}

/// Kinds of boxes that a user may show on a model: path of the request, colour, and parameters.
const BOX_SETS = [
  { name: "boxes", colour: 0x3b78d8, wanted: (choice) => choice.level !== "",
    state: (cut) => cut.cut, more: (choice) => ({ level: choice.level }) },
  { name: "loaded", colour: 0x2f9e6e, wanted: (choice) => choice.regions,
    state: (cut) => `${cut.cut} ${cut.pages}`, more: () => ({}) },
  { name: "requested", colour: 0xd8822b, wanted: (choice) => choice.regions,
    state: (cut, front) => (cut.requested > 0 ? front.serial : "none"), more: () => ({}) },
];

/// Colours of the spheres in which chunks are searched, around a tool's present or predicted place.
const REGION_COLOURS = { present: 0xc94c4c, predicted: 0xa855c7 };
const REGION_BALL = new THREE.WireframeGeometry(new THREE.IcosahedronBufferGeometry(1, 1));

/// Values for the colours of faces, 0 (coarse) to 1 (fine), and texts for both ends of the scale.
function scale_of(cut, by) {
  if (by === "error") {
    let most = 0;
    for (const error of cut.errors) {
      most = Math.max(most, error);
    }
    const span = 3; // Decades of the error between the ends.
    return {
      share: (i) => (cut.errors[i] === 0 ? 1 :
        -Math.log10(cut.errors[i] / most) / span * 0.85),
      least: `${(most * 1e3).toPrecision(2)} mm`, most: "exact",
    };
  }
  let most = 1;
  for (const level of cut.levels) {
    most = Math.max(most, level);
  }
  return { share: (i) => cut.levels[i] / most, least: "base", most: `level ${most}` };
}

/// Geometry with three vertices for each face, so that each face has one colour.
function geometry_of(cut, by) {
  const positions = new Float32Array(9 * cut.faces);
  const colours = new Float32Array(9 * cut.faces);
  const scale = scale_of(cut, by);
  for (let face = 0; face < cut.faces; ++face) {
    const colour = ramp(scale.share(face));
    for (let corner = 0; corner < 3; ++corner) {
      const from = 3 * cut.corners[3 * face + corner];
      const to = 9 * face + 3 * corner;
      positions.set(cut.positions.subarray(from, from + 3), to);
      colours.set(colour, to);
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
  geometry.setAttribute("color", new THREE.BufferAttribute(colours, 3));
  geometry.computeBoundingSphere();
  return { geometry, scale };
}

const vector = (v) => new THREE.Vector3(v[0], v[1], v[2]);
const turn = (q) => new THREE.Quaternion(q[0], q[1], q[2], q[3]);

/// Geometry of a tool in the form of hrtc's --tool option; a sphere if the form is unknown.
function tool_geometry(shape, radius_m) {
  const [kind, numbers] = (shape || "").split(":");
  const sizes = (numbers || "").split(",").map(Number);
  const radius = radius_m > 0 ? radius_m : 1e-4;
  if (kind === "box" && sizes.length >= 3 && sizes.every(Number.isFinite)) {
    const round = 2 * (sizes[3] || 0);
    return new THREE.BoxBufferGeometry(...sizes.slice(0, 3).map((size) => size + round));
  }
  if (kind === "capsule" && sizes.length >= 2 && sizes.every(Number.isFinite)) {
    const [radius, length] = sizes;
    const outline = [];
    for (let i = 0; i <= 16; ++i) {
      const angle = Math.PI * (i / 16 - 0.5);
      outline.push(new THREE.Vector2(Math.max(radius * Math.cos(angle), 1e-6),
        radius * Math.sin(angle) + Math.sign(i - 8) * length / 2));
    }
    const capsule = new THREE.LatheBufferGeometry(outline, 24);
    capsule.rotateX(Math.PI / 2);
    return capsule;
  }
  return new THREE.SphereBufferGeometry(radius, 28, 18);
}

/// Marks of one tool: the device's pose (transparent), the proxy, the force and the nearest points.
class ToolMarks {
  constructor(scene) {
    this.group = new THREE.Group();
    this.shape = null;
    this.device = new THREE.Mesh(undefined, new THREE.MeshBasicMaterial({
      color: 0xc94c4c, transparent: true, opacity: 0.45, depthWrite: false }));
    this.proxy = new THREE.Mesh(undefined, new THREE.MeshPhongMaterial({ color: 0xd8822b }));
    this.force = new THREE.ArrowHelper(new THREE.Vector3(0, 0, 1), new THREE.Vector3(), 1,
      0xc94c4c);
    this.shells = [0, 1].map((i) => new THREE.Mesh(new THREE.SphereBufferGeometry(1, 24, 14),
      new THREE.MeshBasicMaterial({ color: i === 0 ? 0x2f9e6e : 0x3b78d8, wireframe: true,
        transparent: true, opacity: 0.25 })));
    this.group.add(this.device, this.proxy, this.force, ...this.shells);
    scene.add(this.group);
  }

  show(tool, pairs, reach_m, with_shells) {
    const shape = `${tool.shape} ${tool.radius_m}`;
    if (shape !== this.shape) {
      this.shape = shape;
      this.device.geometry = this.proxy.geometry = tool_geometry(tool.shape, tool.radius_m);
    }
    this.device.position.copy(vector(tool.position_m));
    this.device.quaternion.copy(turn(tool.rotation));
    this.proxy.position.copy(vector(tool.proxy_m));
    this.proxy.quaternion.copy(turn(tool.proxy_rotation));
    const force = vector(tool.force_n);
    const length = force.length();
    this.force.visible = length > 1e-3;
    if (this.force.visible) {
      this.force.position.copy(this.proxy.position);
      this.force.setDirection(force.divideScalar(length));
      const shown_m = Math.min(length, 10) * reach_m * 0.25;
      this.force.setLength(shown_m, Math.min(0.3 * shown_m, 0.05 * reach_m), 0.03 * reach_m);
    }
    const pair = pairs[0];
    [pair && pair.lower_m, pair && pair.upper_m].forEach((radius_m, i) => {
      this.shells[i].visible = with_shells && radius_m > 0;
      if (this.shells[i].visible) {
        this.shells[i].position.copy(this.proxy.position);
        this.shells[i].scale.setScalar(radius_m);
      }
    });
  }
}

/// Empty view for a browser without WebGL; the rest of the page works.
export class NoView {
  show() {}
  recolour() {}
  forget() {}
  fit() {}
  follow() {}
  summary() {
    return { scale: null, faces: 0, boxes: 0, regions: null,
      fault: "no picture: this browser has no WebGL" };
  }
}

/// 3D view of the controller's surfaces and tools.
export class View {
  constructor(canvas, on_change) {
    this.canvas = canvas;
    this.on_change = on_change;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(40, 1, 1e-4, 100);
    this.camera.up.set(0, 0, 1);
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x777788, 0.75), this.camera);
    const lamp = new THREE.DirectionalLight(0xffffff, 0.5);
    lamp.position.set(0.4, 0.6, 1);
    this.camera.add(lamp);
    this.controls = new THREE.OrbitControls(this.camera, canvas);
    this.controls.addEventListener("change", () => this.draw());
    this.controls.addEventListener("start", () => { this.is_fitting = false; });
    this.is_fitting = true; // True until the user moves the view; resizing then fits it.
    this.models = new Map(); // Models by hash: {cut, wanted, data, geometry, scale, fault}.
    this.objects = new Map();
    this.tools = [];
    this.points = new THREE.Points(new THREE.BufferGeometry(), new THREE.PointsMaterial({
      color: 0x111111, size: 7, sizeAttenuation: false, depthTest: false }));
    this.scene.add(this.points);
    this.by = "level";
    this.edges = true;
    this.is_fitted = false;
    this.is_drawing = false;
    this.is_wanted = false; // True if another picture is needed after the present one.
    this.rest_ms = 0;
    this.radius_m = 0.1;
    this.regions = null; // Numbers of regions by kind; null: none are shown.
    this.followed = null; // Number of the tool that the view follows; null: none.
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement);
  }

  /// Shows a controller's state. `choice` is {object, tool, shells, level, regions}.
  show(controller, choice) {
    const front = controller && controller.front;
    if (!front) {
      this.models.forEach((model) => { model.fault = ""; }); // Faults refer to a controller.
    }
    const seen = new Set();
    for (const object of front ? front.objects : []) {
      const key = `${object.server}/${object.object}`;
      const cut = front.models.find((model) => model.hash === object.model);
      seen.add(key);
      this.want(controller, front, object.model, cut);
      this.want_boxes(controller, front, object.model, cut, choice);
      this.place(key, object, choice.object === "" || choice.object === key);
      this.place_regions(this.objects.get(key), choice.regions ?
        front.regions.filter((region) => region.model === object.model) : []);
    }
    this.regions = choice.regions && front ? this.count_regions(front) : null;
    for (const [key, mesh] of this.objects) {
      if (!seen.has(key)) {
        this.scene.remove(mesh);
        this.objects.delete(key);
      }
    }
    this.show_tools(controller, choice);
    if (!this.is_fitted && [...this.objects.values()].some((mesh) => mesh.geometry_is_there)) {
      this.fit();
    }
    this.draw();
  }

  show_tools(controller, choice) {
    const tools = controller ? controller.tools : [];
    while (this.tools.length < tools.length) {
      this.tools.push(new ToolMarks(this.scene));
    }
    const points = [];
    this.tools.forEach((marks, i) => {
      marks.group.visible = i < tools.length;
      if (marks.group.visible) {
        const pairs = controller.pairs.filter((pair) => pair.tool === i);
        marks.show(tools[i], pairs, this.radius_m, choice.shells && i === choice.tool);
        if (tools[i].in_contact) {
          const near_m = (tools[i].radius_m || 0) + 0.005;
          pairs.filter((pair) => pair.lower_m <= near_m)
            .forEach((pair) => points.push(...pair.point_m));
        }
      }
    });
    this.points.geometry.setAttribute("position",
      new THREE.BufferAttribute(new Float32Array(points), 3));
    this.points.visible = points.length > 0;
    this.go_along();
  }

  /// Fetches the model's faces if the shown ones are outdated; one request at a time for each
  /// model.
  want(controller, front, hash, cut) {
    const model = this.models.get(hash) || { cut: null, busy: false, fault: "" };
    this.models.set(hash, model);
    const wanted = cut ? cut.cut : "base";
    if (model.busy || model.cut === wanted || (cut && !cut.is_resident)) {
      return;
    }
    model.busy = true;
    const where = new URLSearchParams({ controller: controller.id, serial: front.serial,
      model: hash });
    fetch(`/front?${where}`)
      .then(async (answer) => {
        if (answer.status === 404) {
          return; // The controller is gone, or a newer state has arrived.
        }
        if (!answer.ok) {
          throw new Error((await answer.text()).trim());
        }
        model.data = read_cut(await answer.arrayBuffer());
        model.cut = wanted;
        model.fault = "";
        this.paint(model);
      })
      .catch((error) => {
        model.fault = error.message;
      })
      .finally(() => {
        model.busy = false;
        this.on_change();
      });
  }

  /// Fetches the chosen boxes of the model; one request at a time for each kind.
  want_boxes(controller, front, hash, cut, choice) {
    const model = this.models.get(hash);
    model.boxes = model.boxes || BOX_SETS.map(() => ({ key: null, busy: false, geometry: null }));
    BOX_SETS.forEach((set, i) => {
      const mine = model.boxes[i];
      mine.visible = set.wanted(choice);
      const more = set.more(choice);
      const key = `${cut ? set.state(cut, front) : "base"} ${more.level}`;
      if (!mine.visible || mine.busy || mine.key === key || !cut || !cut.is_resident) {
        return;
      }
      mine.busy = true;
      const where = new URLSearchParams({ controller: controller.id, serial: front.serial,
        model: hash, ...more });
      fetch(`/${set.name}?${where}`)
        .then(async (answer) => {
          if (answer.ok) {
            const { geometry, count } = read_boxes(await answer.arrayBuffer());
            if (mine.geometry) {
              mine.geometry.dispose();
            }
            Object.assign(mine, { key, geometry, count });
          }
        })
        .catch(() => {}) // The answer for the faces reports the fault.
        .finally(() => {
          mine.busy = false;
          this.on_change();
        });
    });
  }

  paint(model) {
    const old = model.geometry;
    Object.assign(model, geometry_of(model.data, this.by));
    for (const mesh of this.objects.values()) {
      if (mesh.model === model) {
        this.take_geometry(mesh, model);
      }
    }
    if (old) {
      old.dispose();
    }
    this.draw();
  }

  take_geometry(mesh, model) {
    mesh.children[0].geometry = mesh.children[1].geometry = model.geometry;
    mesh.geometry_is_there = true;
  }

  place(key, object, is_chosen) {
    const model = this.models.get(object.model);
    let mesh = this.objects.get(key);
    if (!mesh) {
      mesh = new THREE.Group();
      const surface = new THREE.MeshPhongMaterial({ vertexColors: THREE.VertexColors,
        flatShading: true, side: THREE.DoubleSide, shininess: 8, polygonOffset: true,
        polygonOffsetFactor: 1, polygonOffsetUnits: 1, transparent: true });
      const edges = new THREE.MeshBasicMaterial({ color: 0x000000, wireframe: true,
        transparent: true, opacity: 0.18 });
      mesh.add(new THREE.Mesh(new THREE.BufferGeometry(), surface),
        new THREE.Mesh(new THREE.BufferGeometry(), edges));
      for (const set of BOX_SETS) {
        mesh.add(new THREE.LineSegments(new THREE.BufferGeometry(), new THREE.LineBasicMaterial({
          color: set.colour, transparent: true, opacity: 0.7 })));
      }
      mesh.spheres = new THREE.Group();
      mesh.add(mesh.spheres);
      mesh.geometry_is_there = false;
      this.objects.set(key, mesh);
      this.scene.add(mesh);
    }
    if (model.geometry && mesh.children[0].geometry !== model.geometry) {
      this.take_geometry(mesh, model);
    }
    (model.boxes || []).forEach((boxes, i) => {
      const lines = mesh.children[2 + i];
      lines.visible = boxes.visible && boxes.geometry !== null;
      if (lines.visible) {
        lines.geometry = boxes.geometry;
      }
    });
    mesh.model = model;
    mesh.visible = mesh.geometry_is_there;
    mesh.children[0].material.opacity = is_chosen ? 1 : 0.25;
    mesh.children[1].visible = this.edges;
    mesh.position.copy(vector(object.translation_m));
    mesh.quaternion.copy(turn(object.rotation));
    mesh.scale.setScalar(object.scale);
  }

  /// Draws one sphere on an object for each of its regions.
  place_regions(mesh, regions) {
    while (mesh.spheres.children.length < regions.length) {
      mesh.spheres.add(new THREE.LineSegments(REGION_BALL, new THREE.LineBasicMaterial({
        transparent: true, opacity: 0.5 })));
    }
    mesh.spheres.children.forEach((sphere, i) => {
      sphere.visible = i < regions.length;
      if (sphere.visible) {
        const region = regions[i];
        sphere.material.color.set(REGION_COLOURS[region.is_predicted ? "predicted" : "present"]);
        sphere.position.copy(vector(region.center_m));
        sphere.scale.setScalar(region.radius_m);
      }
    });
  }

  count_regions(front) {
    const predicted = front.regions.filter((region) => region.is_predicted).length;
    const sum = (name) => front.models.reduce((all, model) => all + model[name], 0);
    return { loaded: sum("pages"), requested: sum("requested"),
      present: front.regions.length - predicted, predicted,
      untold: front.regions_left_out > 0 ?
        `${front.regions_left_out} of lower priority not sent` : "" };
  }

  /// Data for the texts of the page: colour scale of the first model, number of faces, regions,
  /// faults.
  summary() {
    const models = [...this.models.values()];
    const shown = models.find((model) => model.scale);
    return {
      scale: shown ? shown.scale : null,
      faces: models.reduce((sum, model) => sum + (model.data ? model.data.faces : 0), 0),
      boxes: models.reduce((sum, model) => sum + (model.boxes || []).reduce(
        (all, boxes) => all + (boxes.visible && boxes.count ? boxes.count : 0), 0), 0),
      regions: this.regions,
      fault: models.map((model) => model.fault).find((fault) => fault) || "",
    };
  }

  recolour(by) {
    this.by = by;
    [...this.models.values()].filter((model) => model.data).forEach((model) => this.paint(model));
  }

  forget() {
    this.models.clear();
    this.objects.forEach((mesh) => this.scene.remove(mesh));
    this.objects.clear();
    this.is_fitted = false;
  }

  fit() {
    this.followed = null;
    this.is_fitting = true;
    const box = new THREE.Box3();
    this.scene.updateMatrixWorld(true);
    for (const mesh of this.objects.values()) {
      if (mesh.geometry_is_there) {
        const sphere = mesh.children[0].geometry.boundingSphere.clone();
        sphere.applyMatrix4(mesh.matrixWorld);
        const half = new THREE.Vector3().setScalar(sphere.radius);
        box.union(new THREE.Box3(sphere.center.clone().sub(half), sphere.center.clone().add(half)));
      }
    }
    if (box.isEmpty()) {
      return;
    }
    const sphere = box.getBoundingSphere(new THREE.Sphere());
    this.radius_m = sphere.radius / Math.sqrt(3);
    this.centre = sphere.center.clone();
    const away_m = 1.25 * this.radius_m / Math.sin(this.camera.fov * Math.PI / 360) /
      Math.min(1, this.camera.aspect);
    this.controls.target.copy(sphere.center);
    this.look(sphere.center, away_m);
    this.camera.near = away_m / 400;
    this.camera.far = away_m * 20;
    this.is_fitted = true;
  }

  /// Moves the camera near a tool and along with it until fit().
  follow(tool) {
    const marks = this.tools[tool];
    if (marks && marks.group.visible) {
      this.look(marks.proxy.position, 0.6 * this.radius_m);
      this.followed = tool;
      this.is_fitting = false;
    }
  }

  go_along() {
    const marks = this.tools[this.followed];
    if (marks && marks.group.visible) {
      const way = marks.proxy.position.clone().sub(this.controls.target);
      this.controls.target.add(way);
      this.camera.position.add(way);
      this.controls.update();
    }
  }

  /// Places the camera `away_m` from `target`, on the side of the first tool and slightly above.
  look(target, away_m) {
    const from = new THREE.Vector3(0.35, -0.5, 0.4);
    const marks = this.tools.find((each) => each.group.visible);
    const outward = marks ? marks.proxy.position.clone().sub(this.centre || target) : from;
    from.add(outward.normalize()).normalize();
    this.controls.target.copy(target);
    this.camera.position.copy(target).add(from.multiplyScalar(away_m));
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.draw();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (width > 0 && height > 0) {
      this.camera.aspect = width / height;
      if (this.is_fitted && this.is_fitting) {
        this.fit();
      }
    }
    this.draw();
  }

  /// Draws soon. Pauses of twice the last picture's time, and fewer pixels if drawing is slow, keep
  /// a machine without a graphics card responsive. No call waits for the picture, which would block
  /// the page.
  draw() {
    this.is_wanted = true;
    if (!this.is_drawing) {
      this.is_drawing = true;
      setTimeout(() => requestAnimationFrame(() => this.draw_now()), this.rest_ms);
    }
  }

  /// Draws now. The second frame that the browser begins after this comes after the picture was
  /// shown.
  draw_now() {
    const begin_ms = performance.now();
    this.is_wanted = false;
    this.render();
    ++this.canvas.dataset.pictures;
    requestAnimationFrame(() => requestAnimationFrame(() => {
      const took_ms = performance.now() - begin_ms;
      this.rest_ms = Math.min(2 * took_ms, 2000);
      if (took_ms > SLOW_MS && this.renderer.getPixelRatio() > LEAST_PIXEL_RATIO) {
        this.renderer.setPixelRatio(this.renderer.getPixelRatio() / 2);
      }
      this.is_drawing = false;
      if (this.is_wanted) {
        this.draw();
      }
    }));
  }

  render() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (width === 0 || height === 0) {
      return;
    }
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.renderer.render(this.scene, this.camera);
  }
}
