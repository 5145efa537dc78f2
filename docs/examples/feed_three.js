// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
// spm_view --pages FOLDER, with this file and feed_three.html in it, then open /pages/feed_three.html.
"use strict";

const words = document.getElementById("words");
const renderer = new THREE.WebGLRenderer({antialias: true});
renderer.setClearColor(0xf2f2f0);
document.body.append(renderer.domElement);
document.body.style.margin = 0; // Styles within the HTML do not apply.
renderer.domElement.style.display = "block";
words.style.cssText = "position: absolute; margin: 12px; font: 16px sans-serif";
const camera = new THREE.PerspectiveCamera(45, 1, 0.001, 10);
function fit_window() {
  renderer.setSize(window.innerWidth, window.innerHeight);
  camera.aspect = window.innerWidth / window.innerHeight;
  camera.updateProjectionMatrix();
}
window.addEventListener("resize", fit_window);
fit_window();
camera.up.set(0, 0, 1);
camera.position.set(0.2, -0.3, 0.2);
camera.lookAt(0, 0, 0);
const scene = new THREE.Scene();
scene.add(new THREE.AmbientLight(0xffffff, 0.4));
const light = new THREE.DirectionalLight(0xffffff, 0.8);
light.position.set(1, -2, 3);
scene.add(light);

// Your mesh of an object, in its source's metres, by name or model hash; here a small frame.
const mesh_of = (object) => new THREE.AxesHelper(0.03);
const ball_of = (tool) => new THREE.Mesh(new THREE.SphereGeometry(tool.radius_m || 0.002, 24, 16),
                                         new THREE.MeshPhongMaterial({color: 0xcc5522}));
const arrow_of = () => new THREE.ArrowHelper(new THREE.Vector3(0, 0, 1), new THREE.Vector3(), 0.01,
                                             0x1155aa);

const shown = new Map();
const there = new Set(); // Keys of the present state; others have gone.
function place(key, make, position_m, rotation, scale = 1) {
  if (!shown.has(key)) {
    shown.set(key, make());
    scene.add(shown.get(key));
  }
  there.add(key);
  const mesh = shown.get(key);
  mesh.position.fromArray(position_m);
  mesh.quaternion.fromArray(rotation); // x, y, z, w, as in the feed.
  mesh.scale.setScalar(scale);
  return mesh;
}

let name = "";
let told_ms = -Infinity; // Time of the newest state.
new EventSource("/feed").onmessage = (event) => {
  const state = JSON.parse(event.data);
  name = state.name;
  told_ms = performance.now();
  there.clear();
  for (const tool of state.tools) {
    place(`tool ${tool.number} ${tool.radius_m}`, () => ball_of(tool), tool.proxy_m,
          tool.proxy_rotation);
    const force_n = new THREE.Vector3().fromArray(tool.force_n);
    const arrow = place(`force ${tool.number}`, arrow_of, tool.proxy_m, [0, 0, 0, 1]);
    arrow.setDirection(force_n.length() > 0 ? force_n.clone().normalize() : arrow.up);
    arrow.setLength(Math.max(0.02 * force_n.length(), 1e-6)); // 20 mm per newton.
  }
  for (const object of state.objects)
    place(`object ${object.number} ${object.model}`, () => mesh_of(object), object.translation_m,
          object.rotation, object.scale);
  for (const [key, mesh] of shown)
    if (!there.has(key) && shown.delete(key)) scene.remove(mesh);
};
renderer.setAnimationLoop(() => {
  words.textContent = performance.now() - told_ms < 1000 ? name : "waiting for a controller";
  renderer.render(scene, camera);
});
