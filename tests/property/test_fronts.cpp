// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// I9: refined and loaded front by region, with and without the cache.

#include "rt_core/frame/fronts.hpp"
#include "tests/property/frame_checks.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace tactus::test
{
namespace
{

using List = std::uint32_t (*)(const Model&, RegionId, std::span<RecordId>) noexcept;

std::vector<std::uint32_t> listed(const Model& model, RegionId region, List list)
{
    std::vector<RecordId> out(count_fronts(model).loaded);
    out.resize(list(model, region, out));
    std::vector<std::uint32_t> records;
    for (const RecordId record : out)
    {
        records.push_back(record.value);
    }
    std::sort(records.begin(), records.end());
    return records;
}

/// Region of a point by the partition's definition, from the header's fields alone.
std::uint32_t cell_of(const HeaderFields& fields, const Vec3f& point_m)
{
    const double cell_m = std::ldexp(fields.region_cell_quanta, fields.quantum_log2);
    std::array<std::uint32_t, 3> cell{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const double at = std::floor(static_cast<double>(point_m[axis]) / cell_m);
        cell[axis] = std::min(static_cast<std::uint32_t>(at), fields.region_grid[axis] - 1);
    }
    return (cell[2] * fields.region_grid[1] + cell[1]) * fields.region_grid[0] + cell[0];
}

/// Expects the refined records among the loaded ones. Over the whole model, cheap enough for every
/// frame.
void expect_refined_is_loaded(const Model& model)
{
    const FrontCount count = count_fronts(model);
    EXPECT_EQ(count.refined, model.forest.refined_records());
    EXPECT_LE(count.refined, count.loaded);
}

/// Checks every region's lists: refined in loaded, each record once and in its own region; sums
/// agree.
void expect_fronts_sound(const Model& model)
{
    std::set<std::uint32_t> loaded_once;
    FrontCount sum;
    for (std::uint32_t region = 0; region < model.header.region_count(); ++region)
    {
        if (!model.header.is_occupied(RegionId{region}))
        {
            continue; // The sums below show that it is empty.
        }
        const auto loaded = listed(model, RegionId{region}, list_loaded_front);
        const auto refined = listed(model, RegionId{region}, list_refined_front);
        EXPECT_TRUE(std::includes(loaded.begin(), loaded.end(), refined.begin(), refined.end()))
            << "region " << region;
        for (const std::uint32_t record : loaded)
        {
            EXPECT_TRUE(loaded_once.insert(record).second) << "record " << record;
            const Vec3f& vertex = model.pages.resident(RecordId{record}).position_m;
            EXPECT_EQ(cell_of(model.header.fields(), vertex), region) << "record " << record;
        }
        sum.loaded += static_cast<std::uint32_t>(loaded.size());
        sum.refined += static_cast<std::uint32_t>(refined.size());
    }
    const FrontCount whole = count_fronts(model);
    EXPECT_EQ(whole.loaded, sum.loaded);
    EXPECT_EQ(whole.refined, sum.refined);
}

/// Number of adopted pages without a refined record.
std::uint32_t idle_pages(const Model& model)
{
    std::uint32_t idle = 0;
    for (std::uint32_t slot = 0; slot < model.pages.capacity(); ++slot)
    {
        const PageTable::Meta& meta = model.pages.meta(slot);
        idle += !meta.chunk.is_none() && meta.refined == 0 ? 1U : 0U;
    }
    return idle;
}

class Fronts : public testing::TestWithParam<std::size_t>
{
protected:
    const TestModel& model_ = small_model(GetParam());
    const std::uint64_t seed_ = seed_of(600 + GetParam());
    Random random_ = Random::seeded(seed_);
    Vec3 goal_{0.0, 0.0, 0.0};

    /// Goal of a slide with a jump every 60 frames.
    Vec3 next_goal(int frame)
    {
        if (frame % 60 == 0)
        {
            const Face& face = model_.faces[random_.below(model_.faces.size())];
            goal_ = to_vec3(face[0]) + random_.in_cube(0.01 * model_.diagonal_m);
        }
        return goal_ += random_.in_cube(0.001 * model_.diagonal_m);
    }
};

TEST_P(Fronts, refined_is_a_subset_of_loaded_in_every_region_and_frame)
{
    SCOPED_TRACE(model_.name + " seed " + std::to_string(seed_));
    FrameRig sut(model_, {});
    std::uint32_t refined_max = 0;
    for (int frame = 0; frame < 180; ++frame)
    {
        static_cast<void>(sut.step(next_goal(frame)));
        expect_refined_is_loaded(sut.model());
        if (frame % 20 == 19)
        {
            expect_fronts_sound(sut.model());
        }
        refined_max = std::max(refined_max, count_fronts(sut.model()).refined);
    }
    EXPECT_GT(refined_max, 20U);
    if (GetParam() == 0) // Other caches may be so small that all their pages are in use.
    {
        EXPECT_GT(idle_pages(sut.model()), 0U) << "a cache keeps what it does not need now";
    }
}

TEST_P(Fronts, agree_to_a_page_when_the_cache_is_off)
{
    SCOPED_TRACE(model_.name + " seed " + std::to_string(seed_));
    RigOptions options;
    options.cache_off = true;
    FrameRig sut(model_, options);
    int finished = 0;
    int touched = 0;
    for (int frame = 0; frame < 360; ++frame)
    {
        const FrameOutput output = sut.step(next_goal(frame));
        expect_refined_is_loaded(sut.model());
        ASSERT_TRUE(answer_is_sound(model_, output)) << "frame " << frame;
        if (sut.model().is_refined)
        {
            ++finished;
            EXPECT_EQ(idle_pages(sut.model()), 0U) << "frame " << frame;
            touched += output.pairs[0].kind == AnswerKind::exact ? 1 : 0;
        }
    }
    EXPECT_GT(finished, 100) << "of 360 frames";
    EXPECT_GT(touched, 30) << "of 360 frames";
    expect_fronts_sound(sut.model());
}

TEST_P(Fronts, a_copy_that_is_brought_up_to_date_now_and_then_is_what_the_slots_are)
{
    SCOPED_TRACE(model_.name + " seed " + std::to_string(seed_));
    RigOptions options;
    options.cache_off = random_.one_in(2); // Many pages are evicted without the cache.
    FrameRig sut(model_, options);
    PagePool& pages = sut.frame().pools().cache.pages;
    std::vector<ShownPage> copy(pages.metas.begin(), pages.metas.end());
    int changed = 0;
    for (int frame = 0; frame < 360; ++frame)
    {
        static_cast<void>(sut.step(next_goal(frame)));
        if (random_.one_in(10))
        {
            const std::vector<ShownPage> before = copy;
            pages.update_copy(copy);
            ASSERT_TRUE(std::equal(copy.begin(), copy.end(), pages.metas.begin()))
                << "frame " << frame;
            changed += before == copy ? 0 : 1;
        }
    }
    EXPECT_GT(changed, 10) << "of some 36 updates";
}

INSTANTIATE_TEST_SUITE_P(small_models, Fronts, testing::Range<std::size_t>(0, 6));

TEST(FrontLists, are_cut_short_at_the_end_of_the_span_and_say_how_many_there_are)
{
    const TestModel& model = small_model(0);
    FrameRig sut(model, {});
    load_everything(sut);
    for (std::uint32_t region = 0; region < sut.model().header.region_count(); ++region)
    {
        const auto all = listed(sut.model(), RegionId{region}, list_loaded_front);
        if (all.size() < 3)
        {
            continue;
        }
        std::array<RecordId, 3> out{RecordId{}, RecordId{}, RecordId{7'777'777}};
        const auto found =
            list_loaded_front(sut.model(), RegionId{region}, std::span(out).first(2));
        EXPECT_EQ(found, all.size());
        EXPECT_TRUE(std::binary_search(all.begin(), all.end(), out[0].value));
        EXPECT_TRUE(std::binary_search(all.begin(), all.end(), out[1].value));
        EXPECT_EQ(out[2].value, 7'777'777U);
        return;
    }
    FAIL() << "no region with three records";
}

} // namespace
} // namespace tactus::test
