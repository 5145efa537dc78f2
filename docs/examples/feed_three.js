// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
// spm_view --pages FOLDER, with this file and feed_three.html in it, then open /pages/feed_three.html.
"use strict";

const renderer = new THREE.WebGLRenderer({antialias: true});
document.body.append(renderer.domElement);
renderer.setSize(window.innerWidth, window.innerHeight);
const camera = new THREE.PerspectiveCamera(45, window.innerWidth / window.innerHeight, 0.001, 10);
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
const arrow_of = () => new THREE.ArrowHelper(new THREE.Vector3(0, 0, 1), new THREE.Vector3(), 0.01);

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

new EventSource("/feed").onmessage = (event) => {
  const state = JSON.parse(event.data);
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
renderer.setAnimationLoop(() => renderer.render(scene, camera));
