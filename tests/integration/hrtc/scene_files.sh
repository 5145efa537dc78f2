#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# scene_files.sh: a glTF scene becomes models, is touched from files and is served; a second run
# replaces the first; a refusal leaves everything unchanged.
source "$(dirname "$0")/common.sh"

# Tetrahedron, shown twice, once mirrored, and once more under another name.
base64 -d >tetra.bin <<<'AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAPgAAgD4AAIA/
AAACAAEAAAABAAMAAQACAAMAAgAAAAMA'
cat >scene.gltf <<'GLTF'
{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
 "nodes": [
  {"name": "table", "children": [1, 2, 3, 4], "translation": [0.25, 0, 0]},
  {"name": "cup", "mesh": 0, "scale": [0.1, 0.1, 0.1],
   "extras": {"tactus": {"material": {"stiffness": 400, "static": 0.4}}}},
  {"name": "cup", "mesh": 0, "scale": [0.1, -0.1, 0.1], "translation": [1, 0, 0]},
  {"name": "jar", "mesh": 1, "scale": [0.2, 0.2, 0.2], "translation": [2, 0, 0]},
  {"name": "lines", "mesh": 2, "extras": {"tactus": {"touch": false}}}],
 "meshes": [
  {"name": "tetra", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]},
  {"name": "same", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]},
  {"name": "lines", "primitives": [{"attributes": {"POSITION": 0}, "mode": 1}]}],
 "accessors": [
  {"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3"},
  {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"}],
 "bufferViews": [{"buffer": 0, "byteLength": 48},
                 {"buffer": 0, "byteOffset": 48, "byteLength": 24}],
 "buffers": [{"byteLength": 72, "uri": "tetra.bin"}]}
GLTF
"$build" scene.gltf -o made >built.txt || fail 'spm_build refuses the scene'
grep -qx 'tetra.spm: 4 faces, .*; 2 objects' built.txt || fault 'two objects share a model'
grep -qx 'made/scene.gltf: 3 objects of 2 models' built.txt || fault 'the last line'
[[ $(ls -A made) == $'scene.gltf\ntetra-mirrored.spm\ntetra.spm' ]] || fault "made: $(ls -A made)"
"$inspect" made/tetra-mirrored.spm >inspected.txt || fault 'the mirrored model is not sound'

# A node of lines is left out by name, with no other effect.
sed 's/, "extras": {"tactus": {"touch": false}}//' scene.gltf >lines.gltf
"$build" lines.gltf -o with_lines >/dev/null 2>said.txt || fault "a node of lines: $(cat said.txt)"
grep -qx "note: node 'lines' (nodes\[4\]) left out: no surface: 1 primitive of LINES" said.txt \
    || fault "lines are not named: $(cat said.txt)"
cmp with_lines/scene.gltf made/scene.gltf || fault 'a node of lines changes the scene'

# A second run gives the same bytes. Another scene leaves unused models as files.
cp made/scene.gltf first.gltf
"$build" scene.gltf -o made/ --json >built.json || fail 'spm_build refuses the folder'
cmp made/scene.gltf first.gltf || fault 'a second run gives another scene'
check built.json objects == 3 models.0.objects == 2 models.0.faces == 4 models.1.objects == 1

# Touch from files: the hand moves to the first object.
contact=0 run_hrtc made/scene.gltf --duration 1
check_clean report.json
check report.json frames == 1000 scene.objects == 3 force.max_n '>' 0
contact=0 run_hrtc --transport file --scene made/scene.gltf --duration 1
check report.json frames == 1000 scene.objects == 3 models == 2 force.max_n '>' 0

# One object or all have another material; a hand moves to an object by name. The recording has all
# names.
told() { # told RECORDING EXPECTED: names, models' names, stiffnesses.
    local told
    "$hrtc" --replay "$1" --export told.jsonl >/dev/null || fault "$1 can't be exported"
    told=$(head -n 1 told.jsonl | python3 -c 'import json, sys
setup = json.load(sys.stdin)["setup"]
print(*(each["name"] for each in setup["models"]),
      *(f"""{each["name"]}:{each["stiffness_n_per_m"] or 0:g}""" for each in setup["objects"]))')
    [[ $told == "$2" ]] || fault "$1 tells: $told"
}
contact=0 run_hrtc made/scene.gltf --duration 1 --material 300 --material cup:700,0.6,0.4 \
    --motion approach:cup-2 --record named.rec
told named.rec 'tetra tetra-mirrored cup:700 cup-2:300 jar:300'
grep -q '^touches     cup (tetra): 0.1 x 0.1 x 0.1 m, around' hrtc.log || fault "$(cat hrtc.log)"

# Served models, with the pose of the first object.
start_publisher made/scene.gltf
grep -q "^serving 'tetra-mirrored' " publish.log || fault 'a model is not served'
grep -qx "showing 3 objects as scene 'scene'" publish.log || fault 'not all objects are shown'
contact=0 run_hrtc --model tetra --duration 2
grep -q '^touches     cup (tetra): 0.1 x 0.1 x 0.1 m, around (0.3, 0.05, 0.05)$' hrtc.log \
    || fault "it is not described where it stands: $(grep '^touches' hrtc.log)"
check report.json models.0.pose.followed == 1 models.0.pose.accepted '>=' 1 \
    models.0.pose.old_frames '<' 1000 models.0.pose.step_max_m == 0 \
    models.0.pose.refused.scale == 0
contact=0 run_hrtc --scene scene --duration 1 --material jar:250 --material late:100 \
    --record served.rec
told served.rec 'tetra tetra-mirrored cup:400 cup-2:0 jar:250'
grep -q "note: --material: no object is called 'late'; there are cup, cup-2, jar; an object" \
    hrtc.log || fault 'a name that no object has is not told'
stop_publisher

# Refusals leave nothing behind and change nothing.
names=$(ls -A made)
before=$(cat made/* | cksum)
sed 's/"scale": \[0.2, 0.2, 0.2\]/"scale": [0.2, 0.1, 0.2]/' scene.gltf >uneven.gltf
sed 's/"mode": 1/"mode": 4/; s/"touch": false/"touch": true/; s/"count": 12/"count": 11/' \
    scene.gltf >corners.gltf
expect 2 "uneven.gltf: node 'jar' (nodes\[3\]) scales its axes" "$build" uneven.gltf -o made
expect 2 "corners.gltf: mesh 'tetra' (meshes\[0\]): *11 corners" "$build" corners.gltf -o other
expect 2 "made/scene.gltf: node 'cup' (nodes\[0\]) names a model already" \
    "$build" made/scene.gltf -o other
expect 2 'scene.gltf: can'\''t be written: File exists' "$build" scene.gltf -o scene.gltf
expect 2 'no/where: can'\''t be written: No such file' "$build" scene.gltf -o no/where
expect 2 --region-size "$build" scene.gltf -o other --region-size 1e-9
expect 2 'missing.glb: no such file' "$build" missing.glb -o other
expect 3 '--output: a glTF scene needs a folder' "$build" scene.gltf -o made.spm
expect 3 '--unit: a glTF scene is in metres' "$build" scene.gltf -o made --unit mm
[[ ! -e other && $(ls -A made) == "$names" && $(cat made/* | cksum) == "$before" ]] \
    || fault 'a refusal left something behind'

refuse_serving() { expect "$1" "$2" "$publish" --domain "$domain" --seconds 5 "${@:3}"; }
refuse_serving 2 "scene.gltf: node 'cup' (nodes\[1\]) names no model" scene.gltf
refuse_serving 3 'FILE: a scene is served alone' made/scene.gltf made/tetra.spm
refuse_serving 3 '--name: a scene is served alone' made/scene.gltf --name a
refuse() { expect "$1" "$2" "$hrtc" --allow-no-rt "${@:3}"; }
refuse 3 "--scene: can't be combined with --model" --transport file \
    --scene made/scene.gltf --model a
refuse 2 "--scene: scene.gltf: node 'cup' (nodes\[1\]) names no model" --transport file \
    --scene scene.gltf
refuse 2 '--objects: 2 is less than the 3 objects at the start' --transport file \
    --scene made/scene.gltf --objects 2
refuse 2 "--material: no object is called 'cap'; cup?" made/scene.gltf --material cap:300
refuse 2 "--motion: no object is called 'pot'; there are cup, cup-2, jar" made/scene.gltf \
    --motion tap:pot
mv made/tetra.spm away.spm
refuse 2 'made/tetra.spm: cannot be opened' --transport file --scene made/scene.gltf
refuse_serving 2 'made/tetra.spm: cannot be opened' made/scene.gltf
finish
