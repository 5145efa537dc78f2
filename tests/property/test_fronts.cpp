// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// I9: refined and loaded front, with and without the cache, and the regions of their records.

#include "rt_core/frame/model.hpp"
#include "tests/property/frame_checks.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::test
{
namespace
{

/// Calls `take(id, record)` for each linked record of each adopted page.
template <typename Take>
void for_each_loaded(const Model& model, const Take& take)
{
    const std::uint32_t records = model.header.counts().records;
    for (std::uint32_t slot = 0; slot < model.pages.capacity(); ++slot)
    {
        const std::uint32_t first = model.pages.is_own(slot)
                                        ? model.pages.meta(slot).chunk.value * kRecordsPerChunk
                                        : records;
        for (std::uint32_t i = first; i < records && i < first + kRecordsPerChunk; ++i)
        {
            if (const VsplitRecord* record = model.pages.find_linked({i}); record != nullptr)
            {
                take(RecordId{i}, *record);
            }
        }
    }
}

struct FrontCount
{
    std::uint32_t loaded{0};
    std::uint32_t refined{0};
};

FrontCount count_fronts(const Model& model)
{
    FrontCount count;
    for_each_loaded(model,
                    [&](RecordId id, const VsplitRecord&)
                    {
                        ++count.loaded;
                        count.refined += model.pages.is_refined(id) ? 1U : 0U;
                    });
    return count;
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

/// Checks that the header finds the region of each loaded record, and knows it as occupied.
void expect_regions_found(const Model& model)
{
    for_each_loaded(model,
                    [&](RecordId id, const VsplitRecord& record)
                    {
                        const Vec3 at = to_vec3(record.position_m);
                        const RegionId region = model.header.region_at({at.x(), at.y(), at.z()});
                        EXPECT_TRUE(model.header.is_occupied(region)) << "record " << id.value;
                        EXPECT_EQ(cell_of(model.header.fields(), record.position_m), region.value)
                            << "record " << id.value;
                    });
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
            expect_regions_found(sut.model());
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
    expect_regions_found(sut.model());
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

} // namespace
} // namespace tactus::test
