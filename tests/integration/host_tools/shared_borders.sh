#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# shared_borders.sh SPM_BUILD SPM_INSPECT: two tiles of a glTF scene, one four times as large as the
# other, keep a common border at any placement of the scene; placing changes no model.
set -euo pipefail
readonly build=$1 inspect=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cd "$scratch"
fail() { printf 'FAULT: %s\n' "$*"; exit 1; }

# Fans of three faces on both sides of a line of four vertices near x = 0.1, with corners at whole
# 2^-20 m between the grid's steps of 2^-17 m.
base64 -d >tiles.bin <<'BYTES'
wJkZvgAAAAAAAPg3wJgZvgBJHD0AVpw8QJ0ZvoConj0AXBy8QJkZvoDo/T0AWJw7cD4JvwBtaj0AYPo6ODOzvwAAAECA8P+9
GDOzvyRxAkCA6ti9qDOzv0T1BEDAxQm+KDOzv0TvB0CAOva9gFH4PcRFBEBAygi+AAABAAQAAQACAAQAAgADAAQAAQAAAAQA
AgABAAQAAwACAAQA
BYTES
cat >tiles.gltf <<'GLTF'
{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
 "nodes": [{"name": "left", "mesh": 0, "translation": [0.25, 0, 0]},
           {"name": "right", "mesh": 1, "translation": [1.5, -2, 0.125]}],
 "meshes": [{"name": "left", "primitives": [{"attributes": {"POSITION": 0}, "indices": 2}]},
            {"name": "right", "primitives": [{"attributes": {"POSITION": 1}, "indices": 3}]}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 5, "type": "VEC3"},
               {"bufferView": 1, "componentType": 5126, "count": 5, "type": "VEC3"},
               {"bufferView": 2, "componentType": 5123, "count": 9, "type": "SCALAR"},
               {"bufferView": 3, "componentType": 5123, "count": 9, "type": "SCALAR"}],
 "bufferViews": [{"buffer": 0, "byteLength": 60},
                 {"buffer": 0, "byteOffset": 60, "byteLength": 60},
                 {"buffer": 0, "byteOffset": 120, "byteLength": 18},
                 {"buffer": 0, "byteOffset": 138, "byteLength": 18}],
 "buffers": [{"byteLength": 156, "uri": "tiles.bin"}]}
GLTF

# border_of FOLDER TILE: prints the places of the tile's vertices in its scene's world, in 0.1 um.
border_of() {
    local at
    "$inspect" "$1/$2.spm" --extract --error 0 -o "$1-$2.obj" >/dev/null
    at=$(tr -d ' \n' <"$1/scene.gltf" \
        | sed -E "s/.*\"name\":\"$2\"[^{}]*\"translation\":\[([^]]*)\].*/\1/")
    awk -v at="$at" 'BEGIN { split(at, t, ",") }
        function whole(x) { return int(x * 1e7 + (x < 0 ? -0.5 : 0.5)) }
        /^v / { print whole($2 + t[1]), whole($3 + t[2]), whole($4 + t[3]) }' "$1-$2.obj" \
        | sort >"$1-$2.txt"
}

for placing in '' --center; do
    made=made$placing
    "$build" tiles.gltf -o "$made" ${placing:+"$placing"} >/dev/null 2>"$made.said" \
        || fail "$(cat "$made.said")"
    border_of "$made" left
    border_of "$made" right
    comm -12 "$made-left.txt" "$made-right.txt" >border.txt
    (($(wc -l <border.txt) == 4)) || fail "borders of $made: $(cat "$made"-{left,right}.txt)"
done
grep -q 'right: 18 bits a coordinate instead of 16, .*: adjacent models have' made.said \
    || fail "$(cat made.said)"
grep -q '^note: moved by -0.667570114, ' made--center.said || fail "$(cat made--center.said)"
"$build" tiles.gltf -o turned --up y --scale 0.3 --center >/dev/null 2>&1 || fail 'not built'
for folder in made--center turned; do
    cmp made/left.spm "$folder/left.spm" || fail "$folder: another model"
    cmp made/right.spm "$folder/right.spm" || fail "$folder: another model"
done

# Fans on both sides of 24 vertices in the middles of steps. Float coordinates in two frames differ
# by the last digit, and half of the vertices would be rounded to other places.
base64 -d >floats.bin <<'BYTES'
hevRvqAaLz7NzEy9UrievvvwdT7Nfiy9UrievvuRXj7NYlC9UrievvtPWz7N0nS9UrievvsgVz7NUk+9UrievvuDTD7Npi+9
Urievvu6OD7NUmq9UrievvtQNz7N6lG9UrievvslLj7NIjm9UrievvuQHz7NFla9UrievvsAHD7N/l69UrievvvAGD7N5lW9
UrievvvsFD7N/jS9UrievvtZDj7NGkS9Urievvu8Cj7Njkq9UrievvvOCD7NMii9UrievvY//D3Npmq9UrievvYx8z3NFka9
UrievvY12j3NfiW9Urievvar2D3NrlC9Urievvb50T3NFk69UrievvbnxT3NpmC9Urievvb5wT3N/ly9Urievvb5sD3N9lK9
Urievvb9rT3NblS9cT0KP/p+ar4K16M8rkfhPk9Nob4Kk5Q8rkfhPk+OoL4Kg5c8rkfhPk9OnL4Kc4M8rkfhPs9Sm74URng8
rkfhPk9OmL4KQ6E8rkfhPs+hlr4KE5w8rkfhPk8/lr4Kc/I8rkfhPk8AkL4KQ7E8rkfhPs+8jb4URlA8rkfhPk9liL4KC+08
rkfhPk9uh74KU6g8rkfhPs+fhb4KO7U8rkfhPk9Wgr4Kc9M8rkfhPk9sgL4Ko5E8rkfhPp+Yfb4U5n48rkfhPp8Ier4KQ5E8
rkfhPp9za74KK8s8rkfhPp9IYr4Km5k8rkfhPp/eYL4UllE8rkfhPp8VTb4KI948rkfhPp94Qr4Ky548rkfhPp9JPr4Ulic8
rkfhPp8HO74Kq5w8rkfhPp+oI74Kc+Q8
BYTES
cat >floats.gltf <<'GLTF'
{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
 "nodes": [{"name": "left", "mesh": 0, "translation": [0.31, -0.17, 0.05]},
           {"name": "right", "mesh": 1, "translation": [-0.44, 0.23, -0.02]}],
 "meshes": [{"name": "left", "primitives": [{"attributes": {"POSITION": 0}, "mode": 6}]},
            {"name": "right", "primitives": [{"attributes": {"POSITION": 1}, "mode": 6}]}],
 "accessors": [{"bufferView": 0, "componentType": 5126, "count": 25, "type": "VEC3"},
               {"bufferView": 1, "componentType": 5126, "count": 25, "type": "VEC3"}],
 "bufferViews": [{"buffer": 0, "byteLength": 300},
                 {"buffer": 0, "byteOffset": 300, "byteLength": 300}],
 "buffers": [{"byteLength": 600, "uri": "floats.bin"}]}
GLTF
"$build" floats.gltf -o floats --memory-mib 40 >/dev/null 2>floats.said || fail "$(cat floats.said)"
border_of floats left
border_of floats right
comm -12 floats-left.txt floats-right.txt >border.txt
(($(wc -l <border.txt) == 24)) || fail "borders of floats: $(cat floats-{left,right}.txt)"

# The same with one face on the right, whose edge contains the left's vertices: it gets them.
base64 -d >floats.bin <<'BYTES'
hevRvqAaLz7NzEy9UrievoLugj4VJx+9UrievgVNgD6C4yG9UrieviUncD4tcSq9UrievkxTaj7veC29UrievnbmST5fVT69
UrievomRRT4DlkC9UrievqdKPD7zaEW9UrievpuxND5gXEm9UrievlhzLz5aFky9Urievn7ZIT7qKFO9UrievtkqID7ZCFS9
UrievkEJGz7rs1a9UrievuNSFT5ZrFm9Urievt6bDT5cr129UrievgBNBz4X92C9UrievoMi9j2ZU2e9UrievvRy2z3NQ269
UrievnV60T1z23C9UrievstHxT1YB3S9UrievvyKvj3Lx3W9Urievm2XvT0eB3a9UrievoE4uT0KKne9UrieviIDtT0oQni9
UrievpOpsT0fIXm9cT0KP/p+ar4K16M8rkfhPmhioL7NXBY8rkfhPpa8E756Iv88
BYTES
sed -i '/"bufferView": 1,/s/"count": 25/"count": 3/
    s/"byteOffset": 300, "byteLength": 300/"byteOffset": 300, "byteLength": 36/
    s/"byteLength": 600/"byteLength": 336/' floats.gltf
"$build" floats.gltf -o edge >/dev/null 2>edge.said || fail "$(cat edge.said)"
grep -q '^note: right: 22 faces added where a border vertex lies on another edge' edge.said \
    || fail "$(cat edge.said)"
border_of edge left
border_of edge right
comm -12 edge-left.txt edge-right.txt >border.txt
(($(wc -l <border.txt) == 24)) || fail "borders of edge: $(cat edge-{left,right}.txt)"

# A request for too few bits is reported.
printf 'OFF 3 1 0\n0 0 0\n0.1 0 0\n0.1 1e-5 0\n3 0 1 2\n' >needle.off
"$build" needle.off -o needle.spm --position-bits 16 >/dev/null 2>needle.said
grep -q '^note: 16 bits a coordinate give steps .* without --position-bits the ' needle.said \
    || fail "$(cat needle.said)"
