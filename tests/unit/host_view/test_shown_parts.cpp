// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_view/cut.hpp"
#include "host_tools/spm_view/film.hpp"
#include "rt_core/abtree/ab_tree.hpp"
#include "tests/shared/temporary_folder.hpp"
#include "tests/unit/host_view/settled_rig.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

namespace tactus::view
{
namespace
{

using Box = std::array<float, 6>;

std::vector<Box> read_boxes(const std::string& bytes)
{
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data(), sizeof(count));
    EXPECT_EQ(bytes.size(), sizeof(count) + count * sizeof(Box));
    std::vector<Box> boxes(count);
    std::memcpy(boxes.data(), bytes.data() + sizeof(count), count * sizeof(Box));
    return boxes;
}

/// Boxes of a tree at work, down to a level.
void collect(const AbTree& tree, TreeRef ref, const Aabb& box, std::uint32_t level,
             std::vector<Box>& boxes)
{
    if (level == 0 || ref.is_block())
    {
        boxes.push_back(
            {box.low[0], box.low[1], box.low[2], box.high[0], box.high[1], box.high[2]});
        return;
    }
    const AbNode& node = tree.node(ref.index());
    for (std::uint32_t child = 0; child < kNodeChildren; ++child)
    {
        if ((node.mask >> child & 1U) != 0)
        {
            collect(tree, node.children[child], node.box_of(child), level - 1, boxes);
        }
    }
}

struct Boxes : ::testing::Test
{
    const std::unique_ptr<tactus::test::FrameRig> rig_ = test::settled_rig();
    const std::vector<RefinementStatePage> pages_ = test::pages_of(rig_->model());
    const test::Shelved shelved_;
};

TEST_F(Boxes, of_the_tree_are_the_controllers_own_at_each_level)
{
    const auto decoded = decode_cut(*shelved_.known, pages_);
    ASSERT_TRUE(decoded.has_value()) << decoded.error().text;
    const AbTree& tree = rig_->model().tree;
    std::size_t last = 0;
    for (const std::uint32_t level : {0U, 1U, 2U, 3U, kTreeLevelsMax, 1'000'000U})
    {
        const auto bytes = tree_box_bytes(decoded.value(), pages_, level);
        ASSERT_TRUE(bytes.has_value()) << bytes.error().text;
        std::vector<Box> shown = read_boxes(bytes.value());
        std::vector<Box> had;
        collect(tree, tree.root(), tree.box(), level, had);
        std::ranges::sort(shown);
        std::ranges::sort(had);
        EXPECT_EQ(shown, had) << level;
        EXPECT_GE(shown.size(), last);
        last = shown.size();
    }
    EXPECT_EQ(last, tree.blocks_used());
}

TEST_F(Boxes, of_chunks_hold_the_vertices_that_these_bring)
{
    const auto bytes = chunk_box_bytes(*shelved_.known, chunks_of(pages_));
    ASSERT_TRUE(bytes.has_value()) << bytes.error().text;
    const std::vector<Box> boxes = read_boxes(bytes.value());
    ASSERT_EQ(boxes.size(), pages_.size());
    const auto decoded = decode_cut(*shelved_.known, pages_);
    ASSERT_TRUE(decoded.has_value());
    std::size_t looked = 0;
    for (std::size_t i = 0; i < pages_.size(); ++i)
    {
        for (std::uint32_t place = 0; place < kRecordsPerChunk; ++place)
        {
            if ((pages_[i].refined >> place & 1U) == 0)
            {
                continue;
            }
            const RecordId id{pages_[i].chunk.value * kRecordsPerChunk + place};
            const Vec3f at_m = decoded.value().record(id).position_m;
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                EXPECT_LE(boxes[i][axis], at_m[axis]);
                EXPECT_GE(boxes[i][3 + axis], at_m[axis]);
            }
            ++looked;
        }
    }
    EXPECT_GT(looked, 20U);
    EXPECT_FALSE(chunk_box_bytes(*shelved_.known, std::vector<ChunkId>{{0xFFFFU}}).has_value());
    EXPECT_TRUE(chunk_box_bytes(*shelved_.known, {}).has_value());
}

constexpr std::uint32_t kFrames = 160;

/// Rig state in a frame.
struct Had
{
    Vec3 proxy_m;
    std::vector<double> lower_m; ///< Bounds by pair.
    std::vector<RefinementStatePage> pages;
    std::vector<RefinementStateRegion> regions;
    std::uint32_t active_faces{0};
};

/// The hand moves to a corner of the model and away, slightly beside it from frame `aside_from` on.
std::vector<Had> record(const std::filesystem::path& path, std::uint32_t frames,
                        std::uint32_t aside_from = kFrames)
{
    const tactus::test::TestModel& model = tactus::test::small_model(0);
    tactus::test::RigOptions options;
    options.record = true;
    options.tools = {{0.01 * model.diagonal_m, 500.0}};
    tactus::test::FrameRig rig(model, options);
    rig.recorder().add_name({RecordedName::Kind::model, 0}, "cup");
    rig.recorder().add_name({RecordedName::Kind::object, 0}, "cup-2");
    std::vector<Had> had;
    for (std::uint32_t frame = 0; frame < frames; ++frame)
    {
        const double way = 0.02 * model.diagonal_m * (1.0 - std::abs(1.0 - frame / 80.0));
        const double aside_m = frame < aside_from ? 0.0 : 1e-3;
        const Vec3 goal_m =
            to_vec3(model.faces.front()[0]) + Vec3(0.02 * model.diagonal_m - way, aside_m, 0.0);
        const FrameOutput output = rig.step(goal_m);
        Had& now = had.emplace_back();
        now.proxy_m = output.tools[0].proxy_m;
        for (const PairOutput& pair : output.pairs)
        {
            now.lower_m.push_back(pair.lower_m);
        }
        now.pages = test::pages_of(rig.model());
        std::ranges::transform(rig.frame().regions(), std::back_inserter(now.regions),
                               shown_region_of);
        now.active_faces = rig.model().forest.active_faces();
    }
    const std::vector<std::byte> bytes = rig.finish_recording();
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    return had;
}

std::unique_ptr<Film> develop(const std::filesystem::path& path, ModelShelf& shelf,
                              std::uint8_t number = 1)
{
    auto film = Film::develop(path.string(), number, shelf, {});
    EXPECT_TRUE(film.has_value()) << film.error().text;
    return std::move(film).value();
}

TEST(Film, has_of_each_frame_what_the_frame_had_and_its_faces_without_a_model_file)
{
    const tactus::test::TemporaryFolder folder;
    const auto had = record(folder.path() / "run.rec", kFrames);
    ModelShelf shelf;
    const auto sut = develop(folder.path() / "run.rec", shelf);
    ASSERT_EQ(sut->frames(), kFrames);
    EXPECT_EQ(sut->note(), "");
    EXPECT_EQ(sut->at(0).told.models[0].name, "cup");
    ASSERT_EQ(sut->at(0).objects.size(), 1U);
    EXPECT_EQ(sut->at(0).objects[0].name, "cup-2");
    std::size_t cuts = 0;
    for (const std::uint32_t frame : {159U, 0U, 80U, 81U, 79U, 40U, 120U}) // Random order.
    {
        SCOPED_TRACE(frame);
        const LiveController shown = sut->at(frame);
        const Telemetry& telemetry = shown.told.telemetry;
        EXPECT_EQ(telemetry.frame, frame + 1);
        EXPECT_EQ(telemetry.tools[0].proxy_m[0], had[frame].proxy_m.x());
        ASSERT_EQ(telemetry.pair_count, had[frame].lower_m.size());
        for (std::size_t i = 0; i < had[frame].lower_m.size(); ++i)
        {
            EXPECT_EQ(telemetry.pairs[i].lower_m, had[frame].lower_m[i]);
        }
        EXPECT_EQ(shown.state()->regions, had[frame].regions);
        ASSERT_EQ(shown.state()->models.size(), 1U);
        const RefinementStateModel& model = shown.state()->models[0];
        EXPECT_TRUE(model.pages == had[frame].pages);
        const auto known = shelf.find(model.hash);
        ASSERT_NE(known, nullptr);
        const auto decoded = decode_cut(*known, model.pages);
        ASSERT_TRUE(decoded.has_value()) << decoded.error().text;
        const auto bytes = cut_bytes(decoded.value(), model.pages);
        ASSERT_TRUE(bytes.has_value()) << bytes.error().text;
        std::uint32_t faces = 0;
        bytes.value().copy(reinterpret_cast<char*>(&faces), sizeof(faces), 4);
        EXPECT_EQ(faces, had[frame].active_faces);
        cuts += model.pages.empty() ? 0U : 1U;
        ASSERT_EQ(shown.objects.size(), 1U);
    }
    EXPECT_GT(cuts, 2U);
    EXPECT_FALSE(had[80].regions.empty());
    EXPECT_EQ(sut->at(9'999).told.telemetry.frame, kFrames);
    EXPECT_EQ(sut->state(kFrames), nullptr);
}

TEST(Films, tell_where_two_recordings_first_differ_and_how)
{
    const tactus::test::TemporaryFolder folder;
    record(folder.path() / "one.rec", kFrames);
    record(folder.path() / "same.rec", kFrames);
    record(folder.path() / "other.rec", 150, 90);
    ModelShelf shelf;
    const auto compare = [&](const char* second)
    {
        std::vector<std::unique_ptr<Film>> films;
        films.push_back(develop(folder.path() / "one.rec", shelf, 1));
        films.push_back(develop(folder.path() / second, shelf, 2));
        return Films(std::move(films));
    };
    EXPECT_TRUE(compare("same.rec").differences().empty());
    const Films sut = compare("other.rec");
    ASSERT_FALSE(sut.differences().empty());
    EXPECT_EQ(sut.differences().front().what, "the device poses");
    EXPECT_EQ(sut.differences().front().frame, 90U);
    EXPECT_NE(sut.differences().front().how.find("in 60 of 150 frames, by 1 mm at first"),
              std::string::npos)
        << sut.differences().front().how;
    for (const FilmDifference& difference : sut.differences())
    {
        EXPECT_GE(difference.frame, 90U) << difference.what;
    }
    EXPECT_EQ(sut.differences().back().what, "the length");
    EXPECT_EQ(sut.frames(), kFrames);
    ASSERT_EQ(sut.at(155).controllers.size(), 2U);
    EXPECT_EQ(sut.at(155).controllers[1].told.telemetry.frame, 150U); // The last frame stays.
    EXPECT_NE(sut.state(id_text(sut.films()[1]->id()), 149), nullptr);
    EXPECT_EQ(sut.state("another", 0), nullptr);
}

TEST(Film, shows_a_recording_that_was_cut_as_far_as_it_goes_and_ends_when_it_is_told_to)
{
    const tactus::test::TemporaryFolder folder;
    const auto path = folder.path() / "run.rec";
    record(path, 20);
    ModelShelf shelf;
    int asked = 0;
    const auto part = Film::develop(path.string(), 1, shelf, [&] { return ++asked < 7; });
    ASSERT_TRUE(part.has_value());
    EXPECT_EQ(part.value()->frames(), 7U);
    EXPECT_EQ(part.value()->note(), "");
    std::filesystem::resize_file(path, std::filesystem::file_size(path) - 1);
    const auto cut = Film::develop(path.string(), 1, shelf, {});
    ASSERT_TRUE(cut.has_value());
    EXPECT_EQ(cut.value()->frames(), 20U);
    EXPECT_NE(cut.value()->note().find("the file is incomplete: after frame 19"),
              std::string::npos);
    std::filesystem::resize_file(path, 30);
    const auto refused = Film::develop(path.string(), 1, shelf, {});
    ASSERT_FALSE(refused.has_value());
    EXPECT_NE(refused.error().text.find("run.rec"), std::string::npos);
}

} // namespace
} // namespace tactus::view
