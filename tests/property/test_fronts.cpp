// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// I9: refined and loaded front, with and without the cache.

#include "rt_core/frame/model.hpp"
#include "tests/property/frame_checks.hpp"

namespace tactus::test
{
namespace
{

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

class Fronts : public EachModel<600>
{
protected:
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

TEST_P(Fronts, have_pages_to_spare_when_the_cache_is_on)
{
    FrameRig sut(model_, {});
    std::uint32_t refined_max = 0;
    for (int frame = 0; frame < 180; ++frame)
    {
        static_cast<void>(sut.step(next_goal(frame)));
        refined_max = std::max(refined_max, sut.model().forest.refined_records());
    }
    EXPECT_GT(refined_max, 20U);
    if (GetParam() == 0) // Other caches may be so small that all their pages are in use.
    {
        EXPECT_GT(idle_pages(sut.model()), 0U) << "a cache keeps what it does not need now";
    }
}

TEST_P(Fronts, agree_to_a_page_when_the_cache_is_off)
{
    RigOptions options;
    options.cache_off = true;
    FrameRig sut(model_, options);
    int finished = 0;
    int touched = 0;
    for (int frame = 0; frame < 360; ++frame)
    {
        const FrameOutput output = sut.step(next_goal(frame));
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
}

INSTANTIATE_TEST_SUITE_P(small_models, Fronts, testing::Range<std::size_t>(0, 6));

} // namespace
} // namespace tactus::test
