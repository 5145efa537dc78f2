// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/geometry/placed_core.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/query/core_query.hpp"
#include "rt_core/query/query_memory.hpp"
#include "rt_core/query/surface_query.hpp"
#include "rt_core/query/walk_budget.hpp"
#include "tests/shared/owned_surface.hpp"
#include "tests/unit/rt_core/support.hpp"
#include "tests/unit/rt_core/tree_support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <set>
#include <string>

namespace tactus::test
{

namespace
{

PlacedCore random_core(Random& random)
{
    const Mat3 rotation = Eigen::AngleAxisd{random.between(-4.0, 4.0),
                                            (random.in_cube(1.0) + Vec3(2, 0, 0)).normalized()}
                              .toRotationMatrix();
    const Similarity place{
        rotation,
        {random.between(-2.5, 2.5), random.between(-0.3, 0.8), random.between(-0.3, 0.8)},
        random.between(0.5, 2.0)};
    const double size = random.one_in(6) ? 0.0 : random.between(0.01, 0.8);
    if (random.one_in(3))
    {
        static const std::array<Vec3, 5> wedge{Vec3(0, 0, 0), Vec3(0.4, 0, 0), Vec3(0, 0.3, 0),
                                               Vec3(0, 0, 0.2), Vec3(0.2, 0.2, 0.2)};
        return {Hull::create(wedge).value(), place};
    }
    return random.one_in(2)
               ? PlacedCore(Segment{random.in_cube(size), random.in_cube(size)}, place)
               : PlacedCore(Box{{size, size * random.between(0.0, 1.0), 0.3 * size}}, place);
}

/// Answer by measuring every face, with the kernel that PlacedCore's tests check.
struct CoreTruth
{
    double lower{kInfinity};
    double upper{kInfinity};
    double exact_lower{kInfinity};
    double tolerated_lower{kInfinity};
    double coarse_lower{kInfinity};
    FaceId nearest{};
    double nearest_distance{kInfinity};
    std::set<std::uint32_t> in_reach;

    CoreTruth(std::span<const ChangedFace> faces, const PlacedCore& core, double reach,
              ErrorCode tolerance = 0)
    {
        for (const ChangedFace& face : faces)
        {
            const Triangle triangle = to_triangle(face.corners_m);
            const ClosestPoints closest = core.closest(triangle);
            const double low = std::max(0.0, closest.distance - closest.distance_error);
            const double e = static_cast<double>(error_in_quanta(face.error)) *
                             static_cast<double>(kTreeQuantum);
            double& least = face.error == 0           ? exact_lower
                            : face.error <= tolerance ? tolerated_lower
                                                      : coarse_lower;
            least = std::min(least, low - e);
            for (const Vec3& corner : triangle)
            {
                upper = std::min(upper, core.closest({corner, corner, corner}).distance);
            }
            if (face.error > tolerance)
            {
                continue;
            }
            upper = face.error == 0 ? std::min(upper, closest.distance) : upper;
            if (low - e <= reach)
            {
                in_reach.insert(face.face.value);
            }
            if (closest.distance < nearest_distance ||
                (closest.distance == nearest_distance && face.face < nearest))
            {
                nearest = face.face;
                nearest_distance = closest.distance;
            }
        }
        lower = std::max(0.0, std::min({exact_lower, tolerated_lower, coarse_lower}));
    }
};

struct CoreAnswer
{
    std::unique_ptr<OwnedSurface> surface{std::make_unique<OwnedSurface>()};
    WalkBudget budget;

    [[nodiscard]] const DistanceAnswer& answer() const { return surface->answer; }
};

CoreAnswer ask(const AbTree& tree, const PlacedCore& core, double reach, QueryMemory& memory,
               std::uint32_t nodes = 1'000'000, std::uint32_t triangles = 1'000'000,
               ErrorCode tolerance = 0)
{
    CoreAnswer asked;
    asked.budget = {nodes, triangles};
    gather_surface(tree, core, reach, memory, asked.budget, *asked.surface, ProofShare::most,
                   kEnoughMeetingFaces, tolerance);
    return asked;
}

/// Largest difference of an answer from that with every face measured.
double little_of(ErrorCode tolerance)
{
    return static_cast<double>(error_in_quanta(tolerance)) * static_cast<double>(kTreeQuantum) /
           16.0;
}

bool is_part_of(const std::set<std::uint32_t>& some, const std::set<std::uint32_t>& all)
{
    return std::ranges::includes(all, some);
}

/// Squares that are cut in two, flat at z = 0.
void fill_flat(TreeRig& rig, std::uint32_t cells, float cell, ErrorCode error)
{
    for (std::uint32_t prim = 0; prim < 2 * cells * cells; ++prim)
    {
        const std::uint32_t square = prim / 2;
        const auto corner = [&](std::uint32_t right, std::uint32_t up)
        {
            return Vec3f{cell * static_cast<float>(square % cells + right),
                         cell * static_cast<float>(square / cells + up), 0.0F};
        };
        const bool is_upper = prim % 2 == 1;
        ChangedFace face{PrimId{prim}, FaceId{prim}, prim / 16 << 20U, error, {}};
        face.corners_m = {corner(0, 0), is_upper ? corner(1, 1) : corner(1, 0),
                          is_upper ? corner(0, 1) : corner(1, 1)};
        rig.put(face);
    }
    rig.sut->refit();
}

void fill_scattered(TreeRig& rig, Random& random, std::uint32_t count, bool exact_only)
{
    const FaceStyle& style = face_styles()[random.below(5)];
    for (std::uint32_t prim = 0; prim < count; ++prim)
    {
        ChangedFace face = random_face(random, style, prim, prim);
        face.error = exact_only ? 0 : face.error;
        rig.put(face);
    }
    rig.sut->refit();
}

} // namespace

TEST(CoreQuery, brackets_the_distance_and_finds_what_measuring_every_face_finds)
{
    Random random(61);
    int exact = 0;
    int separated = 0;
    int tolerated = 0;
    for (int round = 0; round < 90; ++round)
    {
        TreeRig rig({200, 400, 400});
        fill_scattered(rig, random, 1 + random.below(200), round % 3 == 0);
        const auto faces = rig.present();
        QueryMemory memory;
        for (int query = 0; query < 30; ++query)
        {
            SCOPED_TRACE("round " + std::to_string(round) + ", query " + std::to_string(query));
            const PlacedCore core = random_core(random);
            const double reach = random.between(0.0, 0.4);
            const ErrorCode tolerance = round % 3 == 2 ? large_error(random, faces) : ErrorCode{0};
            const CoreTruth truth(faces, core, reach, tolerance);

            const CoreAnswer asked =
                ask(*rig.sut, core, reach, memory, 1'000'000, 1'000'000, tolerance);

            const DistanceAnswer& answer = asked.answer();
            ASSERT_LE(answer.lower_m, truth.upper);
            ASSERT_GE(answer.upper_m, truth.upper - 1e-12);
            ASSERT_LE(answer.lower_m, truth.lower + 1e-14);
            ASSERT_LE(answer.certified_radius_m, reach);
            ASSERT_LE(answer.certified_radius_m, std::max(0.0, truth.coarse_lower));
            // Everything within the certified distance is listed; nothing beyond the reach is,
            // except faces that a tolerance leaves unmeasured.
            const auto listed = faces_of(*rig.sut, *asked.surface);
            const double little = little_of(tolerance);
            ASSERT_TRUE(tolerance != 0 || is_part_of(listed, truth.in_reach));
            ASSERT_TRUE(answer.certified_radius_m != reach || is_part_of(truth.in_reach, listed));
            // Coarse faces count with their measured distance, and no less.
            if (truth.coarse_lower > 0.0)
            {
                ASSERT_GE(answer.certified_radius_m, std::min(reach, truth.coarse_lower) - 1e-12);
            }
            if (truth.nearest_distance + 1e-12 < std::min(reach, truth.coarse_lower))
            {
                const AnswerKind known = truth.exact_lower <= std::max(truth.tolerated_lower, 0.0)
                                             ? AnswerKind::exact
                                             : AnswerKind::within_tolerance;
                ASSERT_TRUE(answer.kind == known ||
                            (tolerance != 0 && answer.kind == AnswerKind::within_tolerance));
            }
            exact += answer.kind == AnswerKind::exact ? 1 : 0;
            tolerated += answer.kind == AnswerKind::within_tolerance ? 1 : 0;
            separated += answer.kind == AnswerKind::separated ? 1 : 0;
            if (is_known(answer.kind))
            {
                ASSERT_TRUE(tolerance != 0 || answer.nearest_face == truth.nearest);
                ASSERT_NEAR((answer.nearest_point_m - answer.tool_point_m).norm(),
                            truth.nearest_distance, 1e-11 + little);
                ASSERT_GE(answer.lower_m, truth.lower - 1e-12 - little);
                ASSERT_LE(answer.upper_m, truth.upper + 1e-12 + little);
            }
        }
    }
    EXPECT_GT(exact, 200);
    EXPECT_GT(separated, 300);
    EXPECT_GT(tolerated, 4);
}

TEST(CoreQuery, is_true_when_the_reach_ends_just_before_the_surface)
{
    Random random(63);
    for (int round = 0; round < 40; ++round)
    {
        TreeRig rig({200, 400, 400});
        fill_scattered(rig, random, 200, false);
        const auto faces = rig.present();
        QueryMemory memory;
        for (int query = 0; query < 30; ++query)
        {
            const PlacedCore core = random_core(random);
            const CoreTruth truth(faces, core, 0.0);
            const double reach = random.between(0.85, 1.0) * truth.upper;

            const CoreAnswer asked = ask(*rig.sut, core, reach, memory);

            ASSERT_LE(asked.answer().lower_m, truth.lower + 1e-14) << round << " " << query;
            ASSERT_GE(asked.answer().upper_m, truth.lower);
        }
    }
}

TEST(CoreQuery, a_spent_budget_leaves_the_bracket_true)
{
    Random random(62);
    int spent = 0;
    for (int round = 0; round < 40; ++round)
    {
        TreeRig rig({200, 400, 400});
        fill_scattered(rig, random, 200, round % 2 == 0);
        const auto faces = rig.present();
        for (int query = 0; query < 20; ++query)
        {
            SCOPED_TRACE("round " + std::to_string(round) + ", query " + std::to_string(query));
            const PlacedCore core = random_core(random);
            const CoreTruth truth(faces, core, 0.3);
            QueryMemory memory{random.below(400)};

            const std::uint32_t nodes = random.below(30);
            const CoreAnswer asked = ask(*rig.sut, core, 0.3, memory, nodes, random.below(200));

            spent += asked.budget.is_spent ? 1 : 0;
            ASSERT_LE(asked.answer().lower_m, truth.upper);
            ASSERT_GE(asked.answer().upper_m, truth.lower);
            ASSERT_LE(asked.budget.nodes_visited, asked.budget.nodes);
            ASSERT_LE(asked.budget.triangles_tested, asked.budget.triangles);
        }
    }
    EXPECT_GT(spent, 200);
}

TEST(CoreQuery, ends_where_as_many_faces_as_are_enough_meet_the_core)
{
    Random random(65);
    int ended = 0;
    for (int round = 0; round < 40; ++round)
    {
        TreeRig rig({200, 400, 400});
        fill_scattered(rig, random, 200, round % 2 == 0);
        for (int query = 0; query < 30; ++query)
        {
            SCOPED_TRACE("round " + std::to_string(round) + ", query " + std::to_string(query));
            const PlacedCore core = random_core(random);
            QueryMemory all_memory;
            const CoreAnswer all = ask(*rig.sut, core, 0.2, all_memory);
            QueryMemory memory{random.below(400)};
            CoreAnswer sut;
            sut.budget = {1'000'000, 1'000'000};

            gather_surface(*rig.sut, core, 0.2, memory, sut.budget, *sut.surface, ProofShare::most,
                           1);

            const auto meets = [&](FaceId id)
            {
                const auto faces = rig.present();
                const auto face = std::ranges::find(faces, id, &ChangedFace::face);
                return face != faces.end() && core.closest(to_triangle(face->corners_m)).meet;
            };
            const auto listed = faces_of(*rig.sut, *all.surface);
            const bool is_met =
                std::ranges::any_of(listed, [&](std::uint32_t id) { return meets(FaceId{id}); });
            ASSERT_EQ(meets(sut.answer().nearest_face), is_met);
            if (is_met)
            {
                ++ended;
                ASSERT_EQ(sut.answer().kind, AnswerKind::exact);
                ASSERT_EQ(sut.answer().lower_m, 0.0);
                ASSERT_LT(sut.answer().upper_m, 1e-13);
                ASSERT_LT(sut.answer().certified_radius_m, 0.0);
                ASSERT_LE(sut.budget.triangles_tested, all.budget.triangles_tested + 16);
            }
            else
            {
                ASSERT_EQ(sut.answer().kind, all.answer().kind);
                ASSERT_EQ(faces_of(*rig.sut, *sut.surface), listed);
            }
        }
    }
    EXPECT_GT(ended, 100);
}

/// Half as high as 0.6. Where each face is measured the exact answer of other cores than boxes
/// takes their work, so they are asked with a tolerance only.
ToolCore flat_core(int turn)
{
    static const std::array<Vec3, 8> kFrustum{
        Vec3(-0.3, -0.3, -0.3), Vec3(0.3, -0.3, -0.3), Vec3(-0.3, 0.3, -0.3), Vec3(0.3, 0.3, -0.3),
        Vec3(-0.4, -0.4, 0.3),  Vec3(0.4, -0.4, 0.3),  Vec3(-0.4, 0.4, 0.3),  Vec3(0.4, 0.4, 0.3)};
    static const Hull hull = Hull::create(kFrustum).value();
    return turn == 0   ? ToolCore(Box{{0.4, 0.35, 0.3}})
           : turn == 1 ? ToolCore(Segment{{-0.4, 0.0, -0.3}, {0.4, 0.1, -0.3}})
                       : ToolCore(hull);
}

/// The exact measurements must not grow with the faces below a flat tool: it was halted for that.
class FlatCoreQuery : public testing::TestWithParam<std::pair<ErrorCode, ErrorCode>>
{
};

TEST_P(FlatCoreQuery, a_body_that_lies_flat_measures_few_of_the_faces_below)
{
    constexpr std::uint32_t kCells = 20;
    constexpr float kCell = 0x1p-4F;
    const auto [error, tolerance] = GetParam();
    const bool is_tolerant = tolerance != 0;
    Random random(66);
    TreeRig rig({2 * kCells * kCells, 800, 800});
    fill_flat(rig, kCells, kCell, error);
    const auto faces = rig.present();
    QueryMemory memory;
    std::size_t faces_in_reach = 0;
    std::uint32_t most = 0;
    for (int query = 0; query < 200; ++query)
    {
        SCOPED_TRACE("query " + std::to_string(query));
        const double height = random.between(0.01, 0.1);
        const Vec3 middle{random.between(0.5, 0.7), random.between(0.5, 0.7), 0.3 + height};
        const Mat3 turn =
            query % 4 == 0
                ? Mat3(Mat3::Identity())
                : Eigen::AngleAxisd(random.between(-4.0, 4.0), Vec3::UnitZ()).toRotationMatrix();
        const PlacedCore core(flat_core(is_tolerant ? query % 3 : 0), {turn, middle, 1.0});
        const double reach = 1.05 * height;
        const CoreTruth truth(faces, core, reach, tolerance);
        WorkBudget work;
        CoreAnswer asked;
        asked.budget = {1'000'000, 1'000'000};
        asked.budget.frame = &work;

        gather_surface(*rig.sut, core, reach, memory, asked.budget, *asked.surface,
                       ProofShare::most, kEnoughMeetingFaces, tolerance);

        const DistanceAnswer& answer = asked.answer();
        ASSERT_TRUE(is_known(answer.kind));
        ASSERT_TRUE(is_tolerant || answer.kind == AnswerKind::exact);
        ASSERT_TRUE(error == 0 || answer.kind == AnswerKind::within_tolerance);
        ASSERT_NEAR(answer.lower_m, truth.lower, 1e-12 + little_of(tolerance));
        ASSERT_LE(answer.lower_m, truth.lower + 1e-14);
        ASSERT_NEAR(answer.upper_m, truth.upper, 1e-12 + little_of(tolerance));
        ASSERT_TRUE(is_part_of(truth.in_reach, faces_of(*rig.sut, *asked.surface)));
        if (!is_tolerant)
        {
            ASSERT_EQ(answer.nearest_face, truth.nearest);
        }
        faces_in_reach += truth.in_reach.size();
        const std::uint32_t walked = asked.budget.nodes_visited * WorkCost::node +
                                     asked.budget.triangles_tested * WorkCost::triangle;
        most = std::max(most, work.used() - walked);
    }
    // Without a tolerance all of some 350 faces are measured, but most of them at a corner.
    EXPECT_LT(most, is_tolerant ? 60U * WorkCost::measured : 400U * WorkCost::at_corner);
    EXPECT_GT(faces_in_reach, 200U * 100U); // The mean of a query; each of them was measured once.
}

/// Error of the faces, and tolerance.
INSTANTIATE_TEST_SUITE_P(Tolerances, FlatCoreQuery,
                         testing::Values(std::pair<ErrorCode, ErrorCode>{0, 0},
                                         std::pair<ErrorCode, ErrorCode>{0, 12},
                                         std::pair<ErrorCode, ErrorCode>{8, 12}));

TEST(CoreQuery, the_tolerance_tells_of_faces_that_were_not_measured)
{
    constexpr ErrorCode kTolerance = 60;
    Random random(67);
    TreeRig rig({800, 800, 800});
    fill_flat(rig, 20, 0x1p-4F, 0);
    const auto faces = rig.present();
    const double little = little_of(kTolerance);
    QueryMemory memory;
    int unmeasured = 0;
    for (int query = 0; query < 300; ++query)
    {
        SCOPED_TRACE("query " + std::to_string(query));
        // So little tilted that few of the faces below need to be measured.
        const Vec3 axis(random.between(-1.0, 1.0), random.between(-1.0, 1.0), 0.0);
        const Mat3 tilt = Eigen::AngleAxisd(random.between(0.0, 2.0) * little, axis.normalized())
                              .toRotationMatrix();
        const Vec3 middle{random.between(0.5, 0.7), random.between(0.5, 0.7), 0.35};
        const PlacedCore core(flat_core(query % 3), {tilt, middle, 1.0});
        const CoreTruth truth(faces, core, 0.1, kTolerance);

        const CoreAnswer asked = ask(*rig.sut, core, 0.1, memory, 1'000'000, 1'000'000, kTolerance);

        ASSERT_TRUE(is_known(asked.answer().kind));
        ASSERT_GE(asked.answer().lower_m,
                  truth.nearest_distance - asked.answer().tolerated_m - 1e-12);
        ASSERT_LE(asked.answer().tolerated_m, little);
        unmeasured += truth.nearest_distance - asked.answer().lower_m > 1e-9 ? 1 : 0;
    }
    EXPECT_GT(unmeasured, 20);
}

TEST(CoreQuery, a_point_gets_the_answer_of_a_point)
{
    Random random(63);
    TreeRig rig({200, 400, 400});
    fill_scattered(rig, random, 200, false);
    for (int query = 0; query < 100; ++query)
    {
        SCOPED_TRACE("query " + std::to_string(query));
        const Vec3 at = random.in_cube(1.0);
        QueryMemory memory;
        const CoreAnswer asked =
            ask(*rig.sut, PlacedCore(PointCore{}, {Mat3::Identity(), at, 2.0}), 0.2, memory);
        WalkBudget budget{1'000'000, 1'000'000};
        QueryMemory own;
        auto surface = std::make_unique<OwnedSurface>();
        gather_surface(*rig.sut, at, 0.2, own, budget, *surface);
        ASSERT_EQ(asked.answer().lower_m, surface->answer.lower_m);
        ASSERT_EQ(asked.answer().upper_m, surface->answer.upper_m);
        ASSERT_EQ(asked.answer().nearest_face, surface->answer.nearest_face);
        ASSERT_EQ(asked.answer().tool_point_m, at);
    }
}

TEST(CoreQuery, from_beyond_the_kernels_the_box_of_everything_answers)
{
    Random random(64);
    TreeRig rig({200, 400, 400});
    fill_scattered(rig, random, 100, true);
    const double far = 1e12;
    const PlacedCore core(Segment{Vec3(-1, 0, 0), Vec3(1, 0, 0)},
                          {Mat3::Identity(), Vec3(far, 0, 0), 10.0});
    QueryMemory memory;
    const CoreAnswer asked = ask(*rig.sut, core, 1.0, memory);
    EXPECT_EQ(asked.answer().kind, AnswerKind::separated);
    EXPECT_LE(asked.answer().lower_m, far - 10.0 + 3.0);
    EXPECT_GE(asked.answer().upper_m, far - 10.0 - 3.0);
    EXPECT_EQ(asked.surface->count, 0U);
}

TEST(CoreQuery, an_empty_tree_has_nothing_near)
{
    TreeRig rig({8, 16, 16});
    rig.sut->refit();
    QueryMemory memory;
    const CoreAnswer asked = ask(*rig.sut, PlacedCore(Box{{1, 1, 1}}, {}), 1.0, memory);
    EXPECT_EQ(asked.answer().kind, AnswerKind::separated);
    EXPECT_EQ(asked.answer().upper_m, kInfinity);
}

} // namespace tactus::test
