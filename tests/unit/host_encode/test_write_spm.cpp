// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/replay.hpp"
#include "host_tools/encode/write_spm.hpp"
#include "tests/golden/golden_model.hpp"
#include "tests/shared/temporary_folder.hpp"
#include "tests/unit/host_encode/encoded_model.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <numeric>
#include <random>
#include <set>
#include <string>
#include <utility>

namespace tactus
{
namespace
{

std::string content_of(const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Fault found by a reader; empty if there is none.
std::string read_back(const std::filesystem::path& path)
{
    const auto store = ModelStore::open(path);
    if (!store)
    {
        return store.error().text;
    }
    std::vector<std::string> damage;
    static_cast<void>(DecodedModel::decode(store.value(), damage));
    return damage.empty() ? "" : damage.front();
}

TEST(WriteSpm, the_same_input_gives_the_same_bytes_with_any_number_of_threads)
{
    for (const unsigned threads : {EncodeOptions{}.threads, 5U})
    {
        const EncodedModel& model = *sample_models()[threads == 5 ? 2 : 1];
        const test::TemporaryFolder folder;
        EncodeOptions options;
        options.threads = threads;
        const auto path = folder.path() / "again.spm";
        ASSERT_TRUE(write_spm(path, model.prepared, model.simplification, options));
        EXPECT_EQ(content_of(path), content_of(model.path));
        EXPECT_EQ(std::filesystem::file_size(path), model.fields.file_bytes);
    }
}

TEST(WriteSpm, the_header_describes_the_mesh)
{
    for (const auto& model : sample_models())
    {
        const HeaderFields& fields = model->store->header().fields();
        EXPECT_EQ(fields.source_faces, model->prepared.mesh.faces.size()) << model->name;
        EXPECT_EQ(fields.source_vertices, model->prepared.mesh.positions.size()) << model->name;
        EXPECT_EQ(fields.origin_m, model->prepared.origin_m) << model->name;
        EXPECT_EQ(fields.rounds, model->simplification.rounds) << model->name;
        EXPECT_EQ(static_cast<double>(model->store->header().quantum_m()),
                  model->prepared.quantum_m)
            << model->name;
    }
}

TEST(WriteSpm, a_mesh_that_is_all_base_has_no_chunks)
{
    PreparedMesh prepared;
    prepared.mesh = {{{0, 0, 0}, {60'000, 0, 0}, {0, 50'000, 0}}, {{0, 1, 2}}};
    prepared.quantum_m = 0x1p-20;
    const Simplification nothing{{}, 0, {0}, {{0, 1, 2}}, {0.0}};
    const test::TemporaryFolder folder;
    ASSERT_TRUE(write_spm(folder.path() / "one.spm", prepared, nothing, {}));
    EXPECT_EQ(read_back(folder.path() / "one.spm"), "");
}

TEST(WriteSpm, refuses_a_base_that_is_larger_than_allowed)
{
    const PreparedMesh prepared = prepare_mesh(make_shape(Shape::torus, 4'000).value(), {}).value();
    const std::size_t faces = prepared.mesh.faces.size();
    ASSERT_GT(faces, kGrownBaseFaces);
    Simplification none;
    none.base_faces.resize(faces);
    std::iota(none.base_faces.begin(), none.base_faces.end(), 0U);
    none.base_corners = prepared.mesh.faces;
    none.base_error.resize(faces);
    none.is_closed = true;
    const test::TemporaryFolder folder;
    EncodeOptions options;
    const auto refused = write_spm(folder.path() / "a.spm", prepared, none, options);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().text.find("--base-faces " + std::to_string(faces)), std::string::npos)
        << refused.error().text;
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
    options.base_faces = static_cast<std::uint32_t>(faces);
    EXPECT_TRUE(write_spm(folder.path() / "a.spm", prepared, none, options));
}

TEST(WriteSpm, lets_a_base_grow_by_itself_up_to_a_quarter_of_the_default_pools)
{
    const PreparedMesh prepared = make_golden_mesh();
    const Simplification none = collapse_plainly(prepared.mesh, prepared.mesh.faces.size());
    ASSERT_EQ(none.base_faces.size(), 512U);
    const test::TemporaryFolder folder;
    EncodeOptions options;
    options.base_faces = 1;
    EXPECT_TRUE(write_spm(folder.path() / "a.spm", prepared, none, options));
}

TEST(WriteSpm, refuses_more_regions_than_a_header_holds)
{
    const EncodedModel& model = *sample_models()[0];
    const test::TemporaryFolder folder;
    EncodeOptions options;
    options.region_size_m = 1e-6;
    const auto refused =
        write_spm(folder.path() / "a.spm", model.prepared, model.simplification, options);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().text.find("--region-size"), std::string::npos);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(WriteSpm, rounds_the_region_size_down_to_a_power_of_two_quanta)
{
    const EncodedModel& model = *sample_models()[0];
    const test::TemporaryFolder folder;
    EncodeOptions options;
    options.region_size_m = model.prepared.quantum_m * 9'000;
    const auto written =
        write_spm(folder.path() / "a.spm", model.prepared, model.simplification, options);
    ASSERT_TRUE(written);
    EXPECT_EQ(written.value().region_cell_quanta, 8'192U);
}

TEST(WriteSpm, refuses_a_folder_that_is_not_there)
{
    const EncodedModel& model = *sample_models()[0];
    const test::TemporaryFolder folder;
    const auto refused =
        write_spm(folder.path() / "none" / "a.spm", model.prepared, model.simplification, {});
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().text.find("a.spm"), std::string::npos);
}

/// True if directed edges are unique, so that no two faces are on the same side of an edge.
bool is_manifold(const TriangleMesh& mesh)
{
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const auto& face : mesh.faces)
    {
        for (std::size_t i = 0; i < 3; ++i)
        {
            if (!edges.emplace(face[i], face[(i + 1) % 3]).second)
            {
                return false;
            }
        }
    }
    return true;
}

TEST(Replay, every_cut_of_the_coarsest_first_order_is_manifold)
{
    for (const auto& model : sample_models())
    {
        Replay sut(*model->decoded);
        EXPECT_TRUE(is_manifold(sut.mesh())) << model->name;
        std::size_t splits = 0;
        for (const RecordId id : coarsest_first(*model->decoded))
        {
            ASSERT_FALSE(sut.split(id)) << model->name;
            if (++splits % 97 == 0)
            {
                EXPECT_TRUE(is_manifold(sut.mesh())) << model->name << " after " << splits;
            }
        }
    }
}

TEST(Replay, any_order_that_respects_dependencies_gives_the_same_mesh)
{
    constexpr unsigned kSeed = 4711;
    for (const auto& model : sample_models())
    {
        Replay expected(*model->decoded);
        std::vector<RecordId> order = in_dependency_order(*model->decoded);
        for (const RecordId id : order)
        {
            ASSERT_FALSE(expected.split(id)) << model->name;
        }
        std::mt19937 random(kSeed);
        std::shuffle(order.begin(), order.end(), random);
        Replay sut(*model->decoded);
        while (!order.empty())
        {
            const auto waiting = std::stable_partition(
                order.begin(), order.end(), [&](RecordId id) { return sut.split(id).has_value(); });
            ASSERT_NE(waiting, order.end()) << model->name << ", seed " << kSeed;
            order.erase(waiting, order.end());
        }
        const ModelCounts counts = model->decoded->header().counts();
        for (std::uint32_t face = 0; face < counts.face_ids(); ++face)
        {
            EXPECT_EQ(sut.is_active({face}), expected.is_active({face})) << model->name;
            EXPECT_EQ(sut.corners({face}), expected.corners({face})) << model->name;
            EXPECT_EQ(sut.state({face}), expected.state({face})) << model->name;
        }
    }
}

TEST(Replay, refuses_a_record_before_its_dependencies_and_changes_nothing)
{
    const EncodedModel& model = *sample_models()[0];
    const RecordId deepest = in_dependency_order(*model.decoded).back();
    ASSERT_GT(model.decoded->record(deepest).depth, 1U);
    Replay sut(*model.decoded);
    const TriangleMesh before = sut.mesh();
    EXPECT_TRUE(sut.split(deepest));
    EXPECT_EQ(sut.mesh().positions, before.positions);
    EXPECT_EQ(sut.mesh().faces, before.faces);
    EXPECT_EQ(sut.face_count(), model.fields.base_faces);
}

TEST(Replay, refuses_to_split_a_record_twice)
{
    const EncodedModel& model = *sample_models()[0];
    const RecordId first = in_dependency_order(*model.decoded).front();
    Replay sut(*model.decoded);
    ASSERT_FALSE(sut.split(first));
    EXPECT_TRUE(sut.split(first));
}

} // namespace
} // namespace tactus
