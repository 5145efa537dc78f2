// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Distances of a whole model compared with brute force and the solid angle.

#include "host_tools/shapes/shapes.hpp"
#include "tests/property/frame_checks.hpp"
#include "tests/shared/surface_points.hpp"
#include "tests/shared/temporary_folder.hpp"
#include "tests/shared/test_model.hpp"
#include "tests/shared/winding_number.hpp"
#include "transport/store/static_model.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace tactus::test
{
namespace
{

std::unique_ptr<StaticModel> open_whole(const TestModel& model)
{
    auto opened = StaticModel::open(model.path);
    EXPECT_TRUE(opened) << opened.error().text;
    return std::move(opened).value();
}

class StaticModelOf : public EachModel<4'100>
{
protected:
    /// Place in the source's frame.
    Vec3 to_source(const Vec3& here_m) const
    {
        return here_m + Vec3(model_.origin_m[0], model_.origin_m[1], model_.origin_m[2]);
    }
    Vec3 to_model(const Vec3& source_m) const
    {
        return source_m - Vec3(model_.origin_m[0], model_.origin_m[1], model_.origin_m[2]);
    }
    /// Places on the surface, near it, in the box and far away.
    std::vector<Vec3> places(std::size_t count)
    {
        std::vector<Vec3> places;
        for (const Vec3& at : SurfacePoints(model_.faces, seed_).draw(count))
        {
            constexpr std::array kFar{0.0, 1e-6, 0.02, 1.0, 100.0};
            const double far = kFar.at(random_.below(kFar.size())) * model_.diagonal_m;
            places.push_back(to_source(at + random_.in_cube(far)));
        }
        return places;
    }
};

TEST_P(StaticModelOf, distances_nearest_points_and_sides_are_those_of_the_source_mesh)
{
    const auto sut = open_whole(model_);
    const std::vector<Vec3> points_m = places(100);
    std::vector<PointDistance> answers(points_m.size());
    ASSERT_TRUE(sut->distances(points_m, answers));
    std::uint32_t sided = 0;
    for (std::size_t i = 0; i < points_m.size(); ++i)
    {
        SCOPED_TRACE(i);
        const Vec3 here_m = to_model(points_m[i]);
        const auto truth = brute_distance(here_m, model_.faces);
        const double slack = 1e-12 * model_.diagonal_m + 1e-13 * here_m.norm();
        EXPECT_LE(answers[i].lower_m, static_cast<double>(truth) + slack);
        EXPECT_GE(answers[i].upper_m, static_cast<double>(truth) - slack);
        EXPECT_LE(answers[i].upper_m - answers[i].lower_m, slack);
        EXPECT_NEAR((points_m[i] - answers[i].nearest_m).norm(), static_cast<double>(truth),
                    2.0 * slack);
        EXPECT_LE(static_cast<double>(brute_distance(to_model(answers[i].nearest_m), model_.faces)),
                  2.0 * slack);
        if (answers[i].side != Side::unsigned_distance)
        {
            ++sided;
            ASSERT_TRUE(sut->header().is_closed());
            const auto winding = winding_number(model_.faces, here_m);
            EXPECT_NEAR(static_cast<double>(winding), answers[i].side == Side::inside ? 1.0 : 0.0,
                        1e-6);
        }
    }
    // A point on the surface has no side.
    EXPECT_EQ(sided > points_m.size() / 2, sut->header().is_closed());
}

TEST_P(StaticModelOf, several_threads_ask_one_model)
{
    const auto sut = open_whole(model_);
    const std::vector<Vec3> points_m = places(100);
    std::array<std::vector<PointDistance>, 3> answers;
    std::vector<std::thread> threads;
    for (std::vector<PointDistance>& own : answers)
    {
        own.resize(points_m.size());
        threads.emplace_back([&] { EXPECT_TRUE(sut->distances(points_m, own)); });
    }
    for (std::thread& thread : threads)
    {
        thread.join();
    }
    for (std::size_t i = 0; i < points_m.size(); ++i)
    {
        EXPECT_EQ(answers[0][i].lower_m, answers[1][i].lower_m);
        EXPECT_EQ(answers[0][i].upper_m, answers[2][i].upper_m);
        EXPECT_EQ(answers[0][i].nearest_m, answers[2][i].nearest_m);
    }
}

INSTANTIATE_TEST_SUITE_P(EachModel, StaticModelOf, testing::Range<std::size_t>(0, kSmallModels));

TEST(StaticModel, what_is_no_place_near_the_model_is_refused_and_nothing_written)
{
    const auto sut = open_whole(small_model(0));
    constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {kNan, kInfinity, -kInfinity, 1e300, -1e12})
    {
        SCOPED_TRACE(bad);
        const std::array points_m{Vec3(0.0, 0.0, 0.0), Vec3(0.0, bad, 0.0)};
        std::array<PointDistance, 2> answers;
        const auto asked = sut->distances(points_m, answers);
        ASSERT_FALSE(asked);
        EXPECT_NE(asked.error().text.find("point 1 (0 "), std::string::npos) << asked.error().text;
        EXPECT_EQ(answers[0].upper_m, kInfinity);
    }
    EXPECT_TRUE(sut->distances({}, {}));
}

TEST(StaticModel, a_file_that_is_missing_cut_or_damaged_is_refused_by_its_name)
{
    const TestModel& model = small_model(0);
    const TemporaryFolder folder;
    const auto refusal_of = [&](const std::filesystem::path& path)
    {
        const auto opened = StaticModel::open(path);
        EXPECT_FALSE(opened);
        return opened ? std::string() : opened.error().text;
    };
    const std::filesystem::path copy = folder.path() / "copy.spm";
    EXPECT_NE(refusal_of(copy).find(copy.string()), std::string::npos);

    std::filesystem::copy_file(model.path, copy);
    {
        std::fstream file(copy, std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(-2, std::ios::end);
        file.put('\x55');
    }
    const std::string damaged = refusal_of(copy);
    EXPECT_NE(damaged.find(copy.string() + ": 1 piece is damaged"), std::string::npos) << damaged;

    std::filesystem::resize_file(copy, std::filesystem::file_size(copy) / 2);
    EXPECT_NE(refusal_of(copy).find(copy.string()), std::string::npos);
}

} // namespace
} // namespace tactus::test
