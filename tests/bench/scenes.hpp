// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/decoded_model.hpp"
#include "host_tools/mesh/triangle_mesh.hpp"
#include "rt_core/math/vec3.hpp"
#include "tests/bench/bench_options.hpp"
#include "tests/shared/face_tree.hpp"
#include "tests/shared/temporary_folder.hpp"
#include "tests/shared/test_model.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::bench
{

/// Probe and mesh; all lengths of the motions are shares of the diagonal.
struct TouchScene
{
    const test::FaceTree& tree;
    double diagonal_m{0.0};
};

inline constexpr double kPeriod_s = 1e-3;
/// Radius of the probe, as a share of the diagonal.
inline constexpr double kRadius_diag = 0.01;
/// Frames of the descent to the surface before a slide counts.
inline constexpr std::uint32_t kApproachFrames = 300;
/// Frames of one cycle of the touching motion: flight, approach, slide, retreat.
inline constexpr std::uint32_t kFlightFrames = 400;
inline constexpr std::uint32_t kTouchFrames = 1'500;
inline constexpr std::uint32_t kRetreatFrames = 300;
inline constexpr std::uint32_t kCycleFrames =
    kFlightFrames + kApproachFrames + kTouchFrames + kRetreatFrames;

/// Centres of a probe that descends to the highest point for kApproachFrames and then slides along
/// the true surface for `frames` at a speed. Each step follows a heading that changes by up to 3
/// rad/s, then moves to the wanted distance from the nearest surface point. That distance is the
/// radius plus a depth that swings between -0.3 % and +0.2 % of the diagonal once a second.
/// Computed from the mesh alone, independent of the measured code.
[[nodiscard]] std::vector<Vec3> slide_motion(const TouchScene& scene, double speed_diag_per_s,
                                             std::uint32_t frames);

/// `frames` centres in cycles of 2.5 s: flight around the object at 2 diag/s and 0.62 diag from its
/// centre, approach to the nearest point, slide at 0.1 diag/s, retreat.
[[nodiscard]] std::vector<Vec3> touch_motion(const TouchScene& scene, std::uint32_t frames);

inline constexpr std::size_t kMiB = std::size_t{1} << 20U;

/// Source of a scene's mesh.
struct SceneSource
{
    const char* name;
    const char* mesh_file; ///< File in TACTUS_MESHES; null: always the stand-in.
    /// Number of subdivisions of each face into four; then noise, unless 0.
    std::uint32_t subdivisions;
    std::uint32_t stand_in_faces; ///< Faces of the bumpy sphere that replaces a missing mesh.
};

inline constexpr SceneSource kTiny{"tiny", nullptr, 0, 4'000};
inline constexpr SceneSource kFandisk{"fandisk-13k", "fandisk.obj", 0, 12'946};
inline constexpr SceneSource kBunny{"bunny-69k", "stanford-bunny.obj", 0, 69'000};
inline constexpr SceneSource kIgea{"igea-269k", "igea.ply", 0, 268'686};
inline constexpr SceneSource kFineBunny{"bunny-1.1M", "stanford-bunny.obj", 2, 1'100'000};
inline constexpr SceneSource kFineIgea{"igea-4.3M", "igea.ply", 2, 4'300'000};

/// Noise of a subdivided mesh: uniform, up to this share of the mean edge length at the vertex.
inline constexpr double kNoiseShare = 0.05;

/// Model on disk with its true source mesh.
struct Scene
{
    test::TestModel model;
    std::unique_ptr<test::FaceTree> tree;

    [[nodiscard]] TouchScene touch() const { return {*tree, model.diagonal_m}; }
};

struct NamedMesh
{
    std::string name;
    TriangleMesh mesh;
};

/// Mesh with all lengths multiplied by `scale`.
[[nodiscard]] TriangleMesh scaled(TriangleMesh mesh, double scale);
/// Faces of a mesh in single precision, relative to `origin` of the mesh frame.
[[nodiscard]] std::vector<test::Face> faces_of(const TriangleMesh& mesh,
                                               const std::array<double, 3>& origin = {});

/// Well-known mesh if available, otherwise a generated stand-in of about its size, marked in the
/// name.
[[nodiscard]] NamedMesh source_mesh(const SceneSource& source);
/// Whole model; a failure if any part is damaged.
[[nodiscard]] DecodedModel decode_all(const ModelStore& store);
/// Finest mesh of a model with at most `faces` faces, or its base mesh.
[[nodiscard]] NamedMesh coarser_mesh(const std::string& name, const test::TestModel& model,
                                     std::uint32_t faces);

/// Scenes, made at the first request and kept. Encoded models are stored in the cache folder, named
/// after the mesh and the encoder's sources, or in a folder that is removed with the store.
/// Encoding takes about 20 us a face on all cores.
class SceneStore
{
public:
    explicit SceneStore(std::filesystem::path cache);

    [[nodiscard]] const Scene& get(const SceneSource& source);
    /// Scene of this mesh, in metres, on a grid of `position_bits`; the name identifies both.
    [[nodiscard]] const Scene& get(const NamedMesh& named,
                                   std::uint32_t position_bits = kMinPositionBits);

private:
    [[nodiscard]] std::unique_ptr<Scene> make(const NamedMesh& named,
                                              std::uint32_t position_bits) const;

    std::optional<test::TemporaryFolder> own_folder_; ///< Folder if there is no cache.
    std::filesystem::path folder_;
    std::map<std::string, std::unique_ptr<Scene>> scenes_;
};

} // namespace tactus::bench
