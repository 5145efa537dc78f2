// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/allocation_counter.hpp"
#include "rt_core/math/infinity.hpp"
#include "tests/bench/judged_queries.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <stdexcept>

namespace tactus::bench
{

namespace
{

constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();

/// The plane z = 0, asked as a contestant; what is wrong with it can be planted.
class PlaneQuery final : public TouchQuery
{
public:
    bool drifts{false};    ///< Does not forget.
    bool allocates{false}; ///< Once a question.
    std::optional<std::size_t> own;
    std::vector<double> asked_bands_m;
    std::vector<std::byte> content;

    [[nodiscard]] std::string name() const override { return "plane"; }
    [[nodiscard]] double distance_m(const Vec3& point_m, double band_m) override
    {
        asked_bands_m.push_back(band_m);
        drift_m_ += drifts ? 1e-3 : 0.0;
        kept_ = allocates ? std::make_unique<double>(band_m) : nullptr;
        nearest_m_ = Vec3(point_m.x(), point_m.y(), 0.0);
        return std::abs(point_m.z()) < band_m ? std::abs(point_m.z()) + drift_m_ : kInfinity;
    }
    [[nodiscard]] Vec3 nearest_m() const override { return nearest_m_; }
    void forget() override { asked_bands_m.clear(); }
    [[nodiscard]] std::optional<std::size_t> own_bytes() const override { return own; }

private:
    double drift_m_{0.0};
    Vec3 nearest_m_{0.0, 0.0, 0.0};
    std::unique_ptr<double> kept_;
};

const std::array<Vec3, 3> kPoints{Vec3(0, 0, 1), Vec3(1, 0, 2), Vec3(0, 1, 3)};
const std::array<double, 3> kBands{kInfinity, 2.5, 2.5};

TEST(JudgeTouch, counts_what_is_planted)
{
    constexpr double kRadius = 1.0;
    constexpr double kTolerance = 0.01;
    const std::vector<double> truth{0.5, 0.5, 0.5, 1.5, 1.5, 1.5};
    const std::vector<double> told{0.9, 1.1, kInfinity, 1.1, 0.9, 0.99};

    const TouchErrors errors = judge_touch(told, truth, kRadius, kTolerance);

    EXPECT_EQ(errors.missed, 2U);
    EXPECT_EQ(errors.invented, 2U);
}

TEST(JudgeTouch, lets_pass_what_is_near_the_radius_and_takes_no_number_for_no)
{
    const std::vector<double> truth{0.995, 1.005, 0.5, 1.5};
    const std::vector<double> told{1.5, 0.5, kNotANumber, kNotANumber};

    const TouchErrors errors = judge_touch(told, truth, 1.0, 0.01);

    EXPECT_EQ(errors.missed, 1U);
    EXPECT_EQ(errors.invented, 0U);
}

TEST(LargestError, counts_up_to_the_band)
{
    const std::vector<double> truth{1.0, 1.9, 5.0, 5.0};
    const std::vector<double> told{1.25, kInfinity, kInfinity, 3.0};
    const std::vector<double> bands{2.0, 2.0, 2.0, 2.0};

    EXPECT_DOUBLE_EQ(largest_error_m(told, truth, bands), 0.25);
    const std::vector<double> wide{kInfinity, 2.0, 2.0, kInfinity};
    EXPECT_DOUBLE_EQ(largest_error_m(told, truth, wide), 2.0);
}

TEST(LargestError, is_infinite_for_what_is_no_number_and_for_what_was_not_found)
{
    const std::vector<double> truth{1.0, 1.0};
    const std::vector<double> bands{kInfinity, kInfinity};
    EXPECT_EQ(largest_error_m(std::vector{kNotANumber, 1.0}, truth, bands), kInfinity);
    EXPECT_EQ(largest_error_m(std::vector{1.0, kInfinity}, truth, bands), kInfinity);
    EXPECT_EQ(largest_error_m({}, {}, {}), 0.0);
}

TEST(LargestPointError, sees_points_beside_the_surface_and_points_too_far_away)
{
    const std::vector<test::Face> faces{
        {Vec3f{-9.0F, -9.0F, 0.0F}, Vec3f{9.0F, -9.0F, 0.0F}, Vec3f{0.0F, 9.0F, 0.0F}}};
    const test::FaceTree tree(faces);
    const Questions questions{{Vec3(0, 0, 1)}, {1.0}};
    const auto error_of = [&](const Vec3& told_m, double distance_m)
    {
        return largest_point_error_m({LeastTimes(1), {distance_m}, {told_m}, 0, std::nullopt},
                                     questions, tree);
    };

    EXPECT_EQ(error_of(Vec3(0, 0, 0), 1.0), 0.0);
    EXPECT_DOUBLE_EQ(error_of(Vec3(0, 0, 0.25), 1.0), 0.25);
    EXPECT_DOUBLE_EQ(error_of(Vec3(0, 0, 2), 1.0), 2.0); // As near, but not on the surface.
    EXPECT_DOUBLE_EQ(error_of(Vec3(0, 0.75, 0), 1.0), 0.25);
    EXPECT_EQ(error_of(Vec3(5, 5, 5), kInfinity), 0.0); // Nothing was told.
}

TEST(ReplayQueries, keeps_what_was_answered_with_each_question_s_band)
{
    PlaneQuery sut;

    const auto answers = replay_queries(sut, kPoints, kBands, 3);

    ASSERT_TRUE(answers);
    EXPECT_EQ(answers.value().distances_m, (std::vector{1.0, 2.0, kInfinity}));
    EXPECT_EQ(answers.value().nearest_m[1], Vec3(1, 0, 0));
    for (const double time_us : answers.value().us.least())
    {
        EXPECT_GE(time_us, 0.0);
        EXPECT_LT(time_us, kInfinity);
    }
    // The first question comes once before.
    EXPECT_EQ(sut.asked_bands_m, (std::vector{kInfinity, kInfinity, 2.5, 2.5}));
    PlaneQuery other;
    const std::array<Vec3, 3> moved{Vec3(0, 0, 1), Vec3(1, 0, 2.25), Vec3(0, 1, 3)};
    EXPECT_NE(replay_queries(other, moved, kBands, 1).value().hash, answers.value().hash);
}

TEST(ReplayQueries, refuses_passes_that_differ)
{
    PlaneQuery sut;
    sut.drifts = true;
    EXPECT_TRUE(replay_queries(sut, kPoints, kBands, 1));
    EXPECT_FALSE(replay_queries(sut, kPoints, kBands, 2));
}

TEST(ReplayQueries, counts_calls_on_the_heap)
{
    PlaneQuery sut;
    sut.asked_bands_m.reserve(100);
    const auto none = replay_queries(sut, kPoints, kBands, 2);
    sut.allocates = true;
    const auto one_each = replay_queries(sut, kPoints, kBands, 2);

    ASSERT_TRUE(none && one_each);
    EXPECT_EQ(none.value().allocations.has_value(), allocation_counter::available());
    EXPECT_EQ(none.value().allocations.value_or(0), 0U);
    EXPECT_EQ(one_each.value().allocations.value_or(3), 3U);
}

constexpr std::size_t kPlantedBytes = 3'000'000;

std::unique_ptr<TouchQuery> make_plane(const std::vector<test::Face>& /*faces*/,
                                       double /*radius_m*/)
{
    auto query = std::make_unique<PlaneQuery>();
    query->content.resize(kPlantedBytes);
    return query;
}

std::unique_ptr<TouchQuery> make_accounted_plane(const std::vector<test::Face>& /*faces*/,
                                                 double /*radius_m*/)
{
    auto query = std::make_unique<PlaneQuery>();
    query->own = 12'345;
    return query;
}

std::unique_ptr<TouchQuery> refuse(const std::vector<test::Face>& /*faces*/, double /*radius_m*/)
{
    throw std::runtime_error("plane: refuses the mesh");
}

TEST(BuildPeer, knows_what_the_heap_gave_or_what_the_peer_says)
{
    const auto built = build_peer({"plane", make_plane}, {}, 1.0);
    ASSERT_TRUE(built);
    EXPECT_GE(built.value().build_ms, 0.0);
    if (allocation_counter::available()) // Under a sanitizer the heap is another one.
    {
        EXPECT_GE(built.value().bytes, static_cast<double>(kPlantedBytes));
        EXPECT_LT(built.value().bytes, static_cast<double>(kPlantedBytes) + 10'000.0);
    }
    const auto accounted = build_peer({"plane", make_accounted_plane}, {}, 1.0);
    EXPECT_EQ(accounted.value().bytes, 12'345.0);
}

TEST(BuildPeer, says_that_a_peer_refuses)
{
    const auto built = build_peer({"plane", refuse}, {}, 1.0);
    ASSERT_FALSE(built);
    EXPECT_EQ(built.error().text, "plane: refuses the mesh");
}

} // namespace

} // namespace tactus::bench
