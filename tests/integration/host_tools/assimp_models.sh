#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# assimp_models.sh SPM_BUILD SPM_INSPECT: the sample files of Debian's package assimp-testmodels.
# Each valid one becomes one or more models that spm_inspect finds sound; each broken one is refused
# with exit code 2 and one line that names it. Files whose validity depends on the release of glTF
# or of an extension must satisfy one of the two.
set -euo pipefail
readonly build=$1 inspect=$2 models=/usr/share/assimp/models
if [[ ! -d $models ]]; then
    echo 'skipped: the package assimp-testmodels is not installed'
    exit 77
fi
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
failures=0

# The engine is an assembly: one of its parts has more than 500 faces that cannot vanish.
good='OBJ/WusonOBJ.obj OBJ/box.obj OBJ/box_longline.obj OBJ/box_mat_with_spaces.obj
    OBJ/box_without_lineending.obj OBJ/concave_polygon.obj OBJ/cube_mtllib_after_g.obj
    OBJ/cube_usemtl.obj OBJ/cube_with_vertexcolors.obj OBJ/cube_with_vertexcolors_uni.obj
    OBJ/empty_mat.obj OBJ/multiple_spaces.obj OBJ/regr01.obj OBJ/regr_3429812.obj
    OBJ/space_in_material_name.obj OBJ/spider.obj OBJ/testmixed.obj OFF/Cube.off OFF/Wuson.off
    PLY/cube.ply PLY/cube_binary.ply PLY/cube_uv.ply PLY/float-color.ply STL/3DSMaxExport.STL
    STL/Spider_ascii.stl STL/Spider_binary.stl STL/Wuson.stl STL/sphereWithHole.stl
    STL/triangle.stl STL/triangle_with_empty_solid.stl STL/triangle_with_two_solids.stl
    glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb
    glTF2/BoxBadNormals-glTF-Binary/BoxBadNormals.glb glTF2/BoxTexcoords-glTF/boxTexcoords.gltf
    glTF2/BoxTextured-glTF-Binary/BoxTextured.glb glTF2/BoxTextured-glTF-Embedded/BoxTextured.gltf
    glTF2/BoxTextured-glTF/BoxTextured.gltf glTF2/cameras/Cameras.gltf
    glTF2/textureTransform/TextureTransformTest.gltf'
broken='OBJ/point_cloud.obj OBJ/testline.obj OBJ/testpoints.obj OFF/invalid.off PLY/issue623.ply
    PLY/points.ply PLY/pond.0.ply glTF/BoxTextured-glTF-Binary/BoxTextured.glb
    glTF2/BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb
    glTF2/IndexOutOfRange/AllIndicesOutOfRange.gltf glTF2/IndexOutOfRange/IndexOutOfRange.gltf
    glTF2/MissingBin/BoxTextured.gltf glTF2/RecursiveNodes/RecursiveNodes.gltf
    glTF2/SchemaFailures/sceneWrongType.gltf glTF2/TestNoRootNode/NoScene.gltf
    glTF2/TestNoRootNode/SceneWithoutNodes.gltf invalid/OutOfMemory.off invalid/empty.obj
    invalid/empty.off invalid/empty.ply invalid/malformed.obj'

# fail NAME WHAT: reports a failure; the test continues with the other files.
fail() {
    printf '%s: %s\n' "$1" "$2"
    sed 's/^/    /' "$scratch/told"
    failures=$((failures + 1))
}

# try NAME: sets `code`; a model is inspected, a refusal is one line with the file's name.
try() {
    local out=$scratch/out.spm model
    [[ ${1,,} == *.gl* ]] && out=$scratch/scene
    rm -rf "$scratch/out.spm" "$scratch/scene"
    code=0
    "$build" "$models/$1" -o "$out" >/dev/null 2>"$scratch/told" || code=$?
    case $code in
        0)
            for model in "$scratch"/out.spm "$scratch"/scene/*.spm; do
                [[ ! -e $model ]] || "$inspect" "$model" >/dev/null 2>"$scratch/told" \
                    || fail "$1" "$(basename "$model") is not sound"
            done
            ;;
        2)
            [[ $(wc -l <"$scratch/told") == 1 \
                && $(<"$scratch/told") == "spm_build: $models/$1: "* ]] \
                || fail "$1" 'expected one line that names the file'
            ;;
        *) fail "$1" "exit code $code" ;;
    esac
}

for name in $good; do
    try "$name"
    ((code == 0)) || fail "$name" 'expected a model'
done
for name in $broken; do
    try "$name"
    ((code == 2)) || fail "$name" 'expected a refusal'
done
known=" ${good//$'\n'/ } ${broken//$'\n'/ } "
while IFS= read -r path; do
    name=${path#"$models/"}
    [[ $known == *" $name "* ]] || try "$name"
done < <(find "$models" -type f -regextype posix-extended \
    -iregex '.*\.(ply|obj|stl|off|gltf|glb)' | sort)
((failures == 0))
