// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/records/local_surface.hpp"
#include "tests/unit/rt_core/kernel_laws.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace tactus::test
{

namespace
{

constexpr float kEverything = 0x1p90F;
constexpr std::uint32_t kFaces = 16; ///< Faces of a scene.
constexpr std::uint32_t kBatches = kFaces / kPlaneLanes;

/// Table of a scene's faces around its probe, known only by their distances from there.
class PlaneRig
{
public:
    explicit PlaneRig(const KernelScene& scene) : scene_(scene)
    {
        table_ = {scene.probe, kBatches, planes_.data(), seen_.data(), lows_.data(), first_.data()};
        lows_.fill(kFarPlane);
        for (std::uint32_t face = 0; face < kFaces; ++face)
        {
            triangles_[face] = {PrimId{face}, block_triangle(scene.block, face)};
            PlaneRows& rows = planes_[face / kPlaneLanes];
            const auto distance =
                static_cast<float>(distance_at({0.0F, 0.0F, 0.0F}, face) * (1.0L - 0x1p-22L));
            rows.offset[face % kPlaneLanes] = distance;
            rows.cone[face % kPlaneLanes] = 1.0F;
            float& low = lows_[face / kPlaneLanes];
            low = std::min(low, distance);
            first_[face / kPlaneLanes] = &triangles_[face - face % kPlaneLanes];
        }
    }
    PlaneRig(const PlaneRig&) = delete;
    PlaneRig(PlaneRig&&) = delete;
    PlaneRig& operator=(const PlaneRig&) = delete;
    PlaneRig& operator=(PlaneRig&&) = delete;
    ~PlaneRig() = default;

    void stand_at(const std::array<float, 3>& place)
    {
        stand_ = place;
        ++stand_number_;
    }
    std::vector<PlaneHit> ask(const Kernels& kernels, const std::array<float, 3>& place,
                              float least, bool knows_lows = true)
    {
        if (!knows_lows)
        {
            std::fill_n(lows_.begin(), kBatches, -kFarPlane);
        }
        std::vector<PlaneHit> hits(kBatches);
        hits.resize(kernels.planes_below(table_, question(place, least), hits.data()).hits);
        last_ = place;
        return hits;
    }
    [[nodiscard]] float least_height(const Kernels& kernels,
                                     const std::array<float, 3>& place) const
    {
        return kernels.least_height(table_, question(place, 0.0F));
    }
    /// True distance, in quanta.
    [[nodiscard]] long double distance_at(const std::array<float, 3>& place,
                                          std::uint32_t face) const
    {
        const auto quantum = static_cast<double>(scene_.quantum_m);
        const Vec3 at = scene_.point_m + quantum * Vec3(static_cast<double>(place[0]),
                                                        static_cast<double>(place[1]),
                                                        static_cast<double>(place[2]));
        return DistanceOracle::distance(at, to_triangle(block_triangle(scene_.block, face))) /
               static_cast<long double>(quantum);
    }
    /// Possible error of the oracle's own place.
    [[nodiscard]] long double off() const { return static_cast<long double>(scene_.probe.slack); }
    [[nodiscard]] std::vector<std::uint32_t> bits() const
    {
        std::vector<std::uint32_t> all;
        for (std::uint32_t i = 0; i < kBatches; ++i)
        {
            all.push_back(bits_of(lows_[i]));
            for (std::uint32_t lane = 0; lane < kPlaneLanes; ++lane)
            {
                for (const auto& row : planes_[i].normal)
                {
                    all.push_back(bits_of(row[lane] + 0.0F));
                }
                all.push_back(bits_of(planes_[i].offset[lane]));
            }
        }
        return all;
    }

private:
    [[nodiscard]] PlaneQuestion question(const std::array<float, 3>& place, float least) const
    {
        double drift_sq = 0.0;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            const double way = static_cast<double>(place[axis]) - static_cast<double>(last_[axis]);
            drift_sq += way * way;
        }
        return {{place[0], place[1], place[2]},
                {stand_[0], stand_[1], stand_[2]},
                stand_number_,
                static_cast<float>(std::sqrt(drift_sq) * (1.0 + 0x1p-22)),
                least,
                least};
    }

    const KernelScene& scene_;
    PlaneTable table_{};
    std::array<PlaneRows, kBatches> planes_{};
    std::array<PlaneSeen, kBatches> seen_{};
    alignas(32) std::array<float, kPlaneLanes> lows_{};
    std::array<const void*, kBatches> first_{};
    std::array<LocalTriangle, kFaces> triangles_{};
    std::array<float, 3> stand_{};
    std::array<float, 3> last_{};
    std::uint32_t stand_number_{1};
};

/// Places roughly as far from the probe as the faces, and some on the probe.
std::array<float, 3> random_place(Random& random, const PlaneRig& rig)
{
    const auto far = static_cast<double>(rig.distance_at({0.0F, 0.0F, 0.0F}, random.below(kFaces)));
    const Vec3 at = random.in_cube((far + 1.0) * std::exp2(-random.between(0.0, 12.0)));
    return {static_cast<float>(at.x()), static_cast<float>(at.y()), static_cast<float>(at.z())};
}

bool is_hit(const std::vector<PlaneHit>& hits, std::uint32_t face)
{
    return std::ranges::any_of(hits,
                               [face](const PlaneHit& hit) {
                                   return hit.batch == face / kPlaneLanes &&
                                          ((hit.lanes >> face % kPlaneLanes) & 1U) != 0;
                               });
}

std::array<float, 3> between(const std::array<float, 3>& a, const std::array<float, 3>& b,
                             float share)
{
    return {a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]),
            a[2] + share * (b[2] - a[2])};
}

} // namespace

TEST(PlaneKernels, never_say_that_a_face_is_farther_than_it_is)
{
    std::uint32_t near_truth = 0;
    std::uint32_t asked = 0;
    Random random(90);
    for (const KernelScene& scene : scenes(random, 40))
    {
        PlaneRig sut(scene);
        const auto stand = random_place(random, sut);
        sut.stand_at(stand);
        static_cast<void>(sut.ask(portable_kernels(), stand, kEverything));
        for (int i = 0; i < 4; ++i)
        {
            const auto place = i == 0 ? stand : random_place(random, sut);
            const auto hits = sut.ask(portable_kernels(), place, kEverything);
            ASSERT_EQ(hits.size(), kBatches) << scene.shape;
            for (std::uint32_t face = 0; face < kFaces; ++face)
            {
                const auto height =
                    static_cast<long double>(hits[face / kPlaneLanes].heights[face % kPlaneLanes]);
                const long double truth =
                    std::min(sut.distance_at(place, face), sut.distance_at(stand, face));
                ASSERT_LE(height, truth + sut.off())
                    << scene.shape << ", probe " << scene.place << ", face " << face;
                asked += i == 0 ? 1U : 0U;
                near_truth += i == 0 && height >= 0.999L * truth ? 1U : 0U;
            }
        }
    }
    EXPECT_GT(near_truth, asked / 2) << "of what it looked at from there";
}

TEST(PlaneKernels, leave_out_no_face_that_is_entered_on_the_way)
{
    std::uint32_t left_out = 0;
    std::uint32_t hit = 0;
    Random random(91);
    for (const KernelScene& scene : scenes(random, 40))
    {
        PlaneRig sut(scene);
        auto stand = random_place(random, sut);
        for (int step = 0; step < 3; ++step)
        {
            const auto place = random_place(random, sut);
            // Near-ties are included: the distance of a face at an end, except for some roundings.
            const std::uint32_t face = random.below(kFaces);
            const long double distance = sut.distance_at(random.one_in(2) ? stand : place, face);
            const auto least = static_cast<float>(
                distance * (random.one_in(2)
                                ? 1.0L + static_cast<long double>(random.between(-1e-6, 1e-6))
                                : static_cast<long double>(random.between(0.1, 1.0))));
            sut.stand_at(stand);
            static_cast<void>(sut.ask(portable_kernels(), stand, least));
            const auto hits = sut.ask(portable_kernels(), place, least);
            for (std::uint32_t i = 0; i < kFaces; ++i)
            {
                if (is_hit(hits, i))
                {
                    ++hit;
                    continue;
                }
                ++left_out;
                for (const float share : {0.0F, 0.1F, 0.25F, 0.5F, 0.75F, 0.9F, 1.0F})
                {
                    const auto at = between(stand, place, share);
                    const long double rounding =
                        sut.off() + 0x1p-22L * (std::abs(static_cast<long double>(at[0])) +
                                                std::abs(static_cast<long double>(at[1])) +
                                                std::abs(static_cast<long double>(at[2])));
                    ASSERT_GE(sut.distance_at(at, i), static_cast<long double>(least) - rounding)
                        << scene.shape << ", probe " << scene.place << ", face " << i;
                }
            }
            stand = place;
        }
    }
    EXPECT_GT(left_out, 10'000U);
    EXPECT_GT(hit, 10'000U);
}

TEST(PlaneKernels, pass_over_only_batches_that_have_no_hit)
{
    Random random(92);
    int number = 0;
    for (const KernelScene& scene : scenes(random, 40))
    {
        SCOPED_TRACE(testing::Message() << scene.shape << ", scene " << number++);
        PlaneRig sut(scene);
        PlaneRig expected(scene);
        for (int i = 0; i < 8; ++i)
        {
            SCOPED_TRACE(i);
            const auto place = random_place(random, sut);
            const long double distance = sut.distance_at(place, random.below(kFaces));
            const auto least =
                static_cast<float>(distance * static_cast<long double>(random.between(0.5, 1.5)));
            if (random.one_in(3))
            {
                sut.stand_at(place);
                expected.stand_at(place);
            }
            const auto hits = sut.ask(portable_kernels(), place, least);
            const auto all = expected.ask(portable_kernels(), place, least, false);
            ASSERT_EQ(hits.size(), all.size());
            for (std::size_t k = 0; k < hits.size(); ++k)
            {
                ASSERT_EQ(hits[k].batch, all[k].batch);
                ASSERT_EQ(hits[k].lanes, all[k].lanes);
                ASSERT_EQ(hits[k].low, all[k].low);
            }
        }
    }
}

TEST(PlaneKernels, know_the_least_height_of_all)
{
    Random random(93);
    for (const KernelScene& scene : scenes(random, 20))
    {
        PlaneRig sut(scene);
        sut.stand_at(random_place(random, sut));
        const auto place = random_place(random, sut);
        const auto hits = sut.ask(portable_kernels(), place, kEverything);
        const auto other = random_place(random, sut);
        float low = kFarPlane;
        for (const Kernels* kernels : available_kernels())
        {
            const float least = sut.least_height(*kernels, other);
            low = kernels == available_kernels().front() ? least : low;
            ASSERT_EQ(least, low) << kernels->name;
            for (std::uint32_t face = 0; face < kFaces; ++face)
            {
                ASSERT_LE(static_cast<long double>(least),
                          sut.distance_at(other, face) + sut.off());
            }
        }
    }
}

TEST(PlaneKernels, of_every_set_give_the_same_bits)
{
    Random random(94);
    for (const KernelScene& scene : scenes(random, 40))
    {
        std::vector<std::array<float, 3>> places;
        std::vector<float> leasts;
        const PlaneRig rig(scene);
        for (int i = 0; i < 6; ++i)
        {
            places.push_back(random_place(random, rig));
            const long double distance = rig.distance_at(places.back(), random.below(kFaces));
            leasts.push_back(
                static_cast<float>(distance * static_cast<long double>(random.between(0.5, 1.5))));
        }
        ASSERT_NO_FATAL_FAILURE(expect_same_of_every_set(
            scene,
            [&](const Kernels& kernels)
            {
                PlaneRig sut(scene);
                std::vector<std::uint32_t> bits;
                for (std::size_t i = 0; i < places.size(); ++i)
                {
                    sut.stand_at(places[i / 3]);
                    for (const PlaneHit& hit : sut.ask(kernels, places[i], leasts[i]))
                    {
                        bits.insert(bits.end(), {hit.batch, hit.lanes, bits_of(hit.low + 0.0F)});
                        for (const float height : hit.heights)
                        {
                            bits.push_back(bits_of(height + 0.0F));
                        }
                    }
                    const auto table = sut.bits();
                    bits.insert(bits.end(), table.begin(), table.end());
                }
                return bits;
            }));
    }
}

TEST(PlaneKernels, leave_out_no_face_whose_squares_are_beyond_float)
{
    Random random(95);
    for (KernelScene scene : scenes(random, 10))
    {
        const auto stand = random_place(random, PlaneRig(scene));
        scene.probe.scale *= 0x1p96F;
        for (const Kernels* kernels : available_kernels())
        {
            PlaneRig sut(scene);
            sut.stand_at(stand);
            const auto hits = sut.ask(*kernels, stand, kEverything);
            for (std::uint32_t face = 0; face < kFaces; ++face)
            {
                ASSERT_TRUE(is_hit(hits, face)) << kernels->name;
            }
        }
    }
}

} // namespace tactus::test
