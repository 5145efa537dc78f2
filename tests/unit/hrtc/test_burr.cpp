// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/edit/sweep.hpp"
#include "platform/controller/cut_sender.hpp"
#include "platform/loop/burr.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

namespace tactus::hrtc::test
{
namespace
{

static_assert(kBurrRoundness == kSweptRoundness);

constexpr double kRadius_m = 0.002;
constexpr std::int64_t kMillisecond_ns = 1'000'000;

BurrLaw sphere(double rate_mm3_per_s)
{
    return {{{Vec3(0.0, 0.0, 0.0)}, kRadius_m}, 1e-9 * rate_mm3_per_s};
}

/// A tool that presses down at (x, 0, 0).
CutSample pressed(std::int64_t millisecond, double x_m, double force_n)
{
    CutSample sample;
    sample.time_ns = (1'000 + millisecond) * kMillisecond_ns;
    sample.proxy_m = {x_m, 0.0, 0.0};
    sample.push = {0.0, 0.0, -1.0};
    sample.force_n = force_n;
    return sample;
}

/// Cuts of a tool that slides for that time along x, each answered at once.
std::vector<BurrCut> slide(BurrLaw& law, std::int64_t milliseconds, double speed_m_per_s,
                           double force_n)
{
    std::vector<BurrCut> cuts;
    for (std::int64_t i = 0; i < milliseconds; ++i)
    {
        law.note_answer();
        const double x_m = 1e-3 * static_cast<double>(i) * speed_m_per_s;
        if (const auto cut = law.add(pressed(i, x_m, force_n)))
        {
            cuts.push_back(*cut);
        }
    }
    return cuts;
}

double volume_mm3(const std::vector<BurrCut>& cuts)
{
    double sum_mm3 = 0.0;
    for (const BurrCut& cut : cuts)
    {
        sum_mm3 += 1e9 * cut.volume_m3;
    }
    return sum_mm3;
}

} // namespace

TEST(Burr, removes_k_times_force_times_speed)
{
    // 1,000 mm^3/(N m) x 0.5 N x (0.01 + 0.05) m/s = 30 mm^3/s.
    BurrLaw sut = sphere(1'000.0);
    const auto cuts = slide(sut, 2'000, 0.01, 0.5);
    EXPECT_GT(cuts.size(), 10U);
    EXPECT_NEAR(volume_mm3(cuts), 60.0, 3.0); // The last cut is not due yet.
}

TEST(Burr, removes_at_most_its_rate)
{
    BurrLaw sut = sphere(20.0);
    EXPECT_NEAR(volume_mm3(slide(sut, 2'000, 0.0, 5.0)), 40.0, 3.0);
}

TEST(Burr, cuts_at_most_thirty_times_a_second)
{
    BurrLaw sut = sphere(kBurrRateMax_mm3_per_s);
    const auto cuts = slide(sut, 1'000, 0.02, 5.0);
    EXPECT_GE(cuts.size(), 25U);
    EXPECT_LE(cuts.size(), 31U);
}

TEST(Burr, goes_in_by_a_depth_that_no_groove_can_exceed)
{
    BurrLaw sut = sphere(100.0);
    Vec3 last_m(0.0, 0.0, 0.0);
    for (const BurrCut& cut : slide(sut, 1'000, 0.02, 1.0))
    {
        const double depth_m = -cut.to_m.z();
        const double length_m = cut.to_m.x() - cut.from_m.x();
        EXPECT_DOUBLE_EQ(cut.from_m.z(), cut.to_m.z());
        EXPECT_GE(cut.from_m.x(), last_m.x()); // Sweeps do not overlap.
        EXPECT_GE(depth_m, kBurrDepthMin * kRadius_m * (1.0 - 1e-12));
        EXPECT_LE(depth_m, kBurrDepthMax * kRadius_m * (1.0 + 1e-12));
        const double shadow_m2 =
            std::numbers::pi * kRadius_m * kRadius_m + 2.0 * kRadius_m * length_m;
        EXPECT_LE(shadow_m2 * (depth_m + kRadius_m / 64.0), cut.volume_m3 * (1.0 + 1e-9));
        last_m = cut.to_m;
    }
}

TEST(Burr, waits_for_the_answer_to_its_last_cut)
{
    BurrLaw sut = sphere(kBurrRateMax_mm3_per_s);
    std::vector<std::int64_t> times;
    for (std::int64_t i = 0; i < 1'000; ++i)
    {
        if (sut.add(pressed(i, 0.0, 5.0)))
        {
            times.push_back(i);
        }
    }
    ASSERT_GT(times.size(), 2U);
    for (std::size_t i = 1; i < times.size(); ++i)
    {
        EXPECT_GE(times[i] - times[i - 1], 100); // Without an answer.
    }
}

TEST(Burr, never_sweeps_across_a_bend)
{
    // Along x, then along y: the straight way between is not where the tool was.
    BurrLaw sut = sphere(200.0);
    for (std::int64_t i = 0; i < 2'000; ++i)
    {
        sut.note_answer();
        const double way_m = 1e-5 * static_cast<double>(i);
        CutSample sample = pressed(i, std::min(way_m, 0.01), 1.0);
        sample.proxy_m[1] = std::max(way_m - 0.01, 0.0);
        if (const auto cut = sut.add(sample))
        {
            const Vec3 way = cut->to_m - cut->from_m;
            EXPECT_LE(std::min(std::abs(way.x()), std::abs(way.y())), kRadius_m / 8.0);
        }
    }
}

TEST(Burr, begins_again_after_a_lift_and_on_another_object)
{
    BurrLaw sut = sphere(kBurrRateMax_mm3_per_s);
    // 0.1 mm^3 in each contact of 2 ms, too little for a cut.
    for (std::int64_t i = 0; i < 5'000; ++i)
    {
        CutSample sample = pressed(i % 2 + i / 2 * 50, 0.0, 1.0);
        EXPECT_FALSE(sut.add(sample));
    }
    for (std::int64_t i = 0; i < 500; ++i)
    {
        CutSample sample = pressed(1'000'000 + i, 0.0, 5.0);
        sample.object = static_cast<std::uint32_t>(i);
        EXPECT_FALSE(sut.add(sample));
    }
}

TEST(Burr, needs_a_shape_with_a_volume)
{
    EXPECT_FALSE(burr_shape(PointCore{}, 0.0));
    EXPECT_FALSE(burr_shape(MeshCore{}, 0.001));
    EXPECT_FALSE(burr_shape(Box{Vec3(0.001, 0.001, 0.001)}, 0.001));
    EXPECT_FALSE(burr_shape(Box{Vec3(0.001, 0.0, 0.001)}, 0.0));
    ASSERT_TRUE(burr_shape(PointCore{}, 0.001));
    const auto capsule = burr_shape(Segment{Vec3(0.0, 0.0, -0.01), Vec3(0.0, 0.0, 0.01)}, 0.001);
    ASSERT_TRUE(capsule);
    EXPECT_EQ(capsule->core_m.size(), 2U);
    const auto box = burr_shape(Box{Vec3(0.001, 0.002, 0.003)}, 0.0);
    ASSERT_TRUE(box);
    EXPECT_EQ(box->core_m.size(), 8U);
}

TEST(Burr, knows_the_shadow_of_a_box)
{
    // A box of 2 x 4 mm seen from above, pressed at rest: d = volume / 8 mm^2.
    BurrLaw sut(*burr_shape(Box{Vec3(0.001, 0.002, 0.003)}, 0.0), 1e-9 * 50.0);
    std::optional<BurrCut> cut;
    for (std::int64_t i = 0; i < 1'000 && !cut; ++i)
    {
        cut = sut.add(pressed(i, 0.0, 5.0));
    }
    ASSERT_TRUE(cut);
    EXPECT_NEAR(-cut->to_m.z(), cut->volume_m3 / 8e-6, 1e-12);
}

TEST(Burr, asks_in_the_frame_of_the_source_and_in_its_scale)
{
    BurrCut cut;
    cut.scale = 2.0;
    cut.from_m = Vec3(0.001, 0.0, 0.0);
    cut.to_m = Vec3(0.002, 0.0, 0.0);
    const BurrShape capsule{{Vec3(0.0, 0.0, 0.0), Vec3(0.0, 0.0, 0.02)}, kRadius_m};
    const EditRequest request = request_of(cut, capsule, Vec3(1.0, 2.0, 3.0));
    EXPECT_TRUE(is_sound(request));
    EXPECT_EQ(request.kind, EditKind::carve);
    EXPECT_DOUBLE_EQ(request.radius_m, 0.001);
    EXPECT_DOUBLE_EQ(request.half_axis_m[2], 0.005);
    EXPECT_DOUBLE_EQ(request.from.translation_m[0], 1.001);
    EXPECT_DOUBLE_EQ(request.from.translation_m[2], 3.005); // The middle of the axis.
    EXPECT_DOUBLE_EQ(request.to.translation_m[0], 1.002);
}

} // namespace tactus::hrtc::test
