// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/decoded_model.hpp"
#include "host_tools/mesh/triangle_mesh.hpp"
#include "tests/bench/bench_options.hpp"
#include "tests/bench/failure.hpp"
#include "tests/bench/touch_motion.hpp"
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

inline constexpr std::size_t kMiB = std::size_t{1} << 20U;

/// Where a scene's mesh comes from.
struct SceneSource
{
    const char* name;
    const char* mesh_file;        ///< In TACTUS_MESHES; null: always the stand-in.
    std::uint32_t subdivisions;   ///< Each face into four, so often; then noise, when not 0.
    std::uint32_t stand_in_faces; ///< Of the bumpy sphere that stands in for it.
};

inline constexpr SceneSource kTiny{"tiny", nullptr, 0, 4'000};
inline constexpr SceneSource kFandisk{"fandisk-13k", "fandisk.obj", 0, 12'946};
inline constexpr SceneSource kBunny{"bunny-69k", "stanford-bunny.obj", 0, 69'000};
inline constexpr SceneSource kIgea{"igea-269k", "igea.ply", 0, 268'686};
inline constexpr SceneSource kFineBunny{"bunny-1.1M", "stanford-bunny.obj", 2, 1'100'000};
inline constexpr SceneSource kFineIgea{"igea-4.3M", "igea.ply", 2, 4'300'000};

/// Noise of a subdivided mesh: uniform, up to this share of the mean edge length at the vertex.
inline constexpr double kNoiseShare = 0.05;

/// A model on disk and the true mesh that it was made of.
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

/// A mesh whose lengths are `scale` times as large.
[[nodiscard]] TriangleMesh scaled(TriangleMesh mesh, double scale);
/// A mesh's faces in single precision, in a frame whose origin lies there in the mesh's own.
[[nodiscard]] std::vector<test::Face> faces_of(const TriangleMesh& mesh,
                                               const std::array<double, 3>& origin = {});

/// The well-known mesh where it is at hand, a generated stand-in of about its size elsewhere, which
/// its name says.
[[nodiscard]] NamedMesh source_mesh(const SceneSource& source);
/// A whole model; a failure when anything in it is damaged.
[[nodiscard]] DecodedModel decode_all(const ModelStore& store);
/// The finest mesh of at most so many faces that a model has, or its base mesh.
[[nodiscard]] NamedMesh coarser_mesh(const std::string& name, const test::TestModel& model,
                                     std::uint32_t faces);

/// Makes scenes when they are first asked for and keeps them. Encoded models go into the cache
/// folder, under a name made of the mesh and of the encoder's sources, or into a folder that goes
/// when the store goes. Encoding takes about 20 us a face on all cores.
class SceneStore
{
public:
    explicit SceneStore(std::filesystem::path cache);

    [[nodiscard]] const Scene& get(const SceneSource& source);
    /// The scene of this mesh, in metres, on a grid of so many bits; its name stands for both.
    [[nodiscard]] const Scene& get(const NamedMesh& named,
                                   std::uint32_t position_bits = kMinPositionBits);

private:
    [[nodiscard]] std::unique_ptr<Scene> make(const NamedMesh& named,
                                              std::uint32_t position_bits) const;

    std::optional<test::TemporaryFolder> own_folder_; ///< Without a cache.
    std::filesystem::path folder_;
    std::map<std::string, std::unique_ptr<Scene>> scenes_;
};

} // namespace tactus::bench
