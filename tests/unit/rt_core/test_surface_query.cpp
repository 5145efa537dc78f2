// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/math/infinity.hpp"
#include "rt_core/query/nearest_triangles.hpp"
#include "rt_core/query/probe.hpp"
#include "rt_core/query/query_memory.hpp"
#include "rt_core/query/surface_query.hpp"
#include "rt_core/query/tree_walk.hpp"
#include "tests/shared/distance_oracle.hpp"
#include "tests/shared/owned_surface.hpp"
#include "tests/unit/rt_core/tree_support.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <set>
#include <string>
#include <vector>

namespace tactus::test
{

namespace
{

constexpr float kInfiniteQuanta = std::numeric_limits<float>::infinity();
/// Error of long double for a thin triangle 10 m away; the law is far below.
constexpr double kSlack = 1e-9;
/// Margin of the kernels: 2 x 4e-5 of 6 m, and 1/256 of an edge of 0.8 m on thin faces.
constexpr double kFilterSlack = 4e-3;

/// Answer by measuring every face.
struct PointTruth
{
    double lower{kInfinity};           ///< Least d - e.
    double upper{kInfinity};           ///< Least exact d or coarse corner's distance.
    double exact_lower{kInfinity};     ///< Least d of exact faces.
    double tolerated_lower{kInfinity}; ///< Least d - e of those within the tolerance.
    double coarse_lower{kInfinity};    ///< Least d - e of the others.
    /// d - e of the surface's faces by place in the list; otherwise infinite.
    std::vector<double> surface;
    FaceId nearest{}; ///< Lowest id of the surface's nearest faces, in the kernel's bits.

    PointTruth(std::span<const ChangedFace> faces, const Vec3& center, ErrorCode tolerance = 0)
    {
        double least_sq = kInfinity;
        for (const ChangedFace& face : faces)
        {
            const Triangle triangle = to_triangle(face.corners_m);
            const auto d = static_cast<double>(DistanceOracle::distance(center, triangle));
            const double e = static_cast<double>(error_in_quanta(face.error)) *
                             static_cast<double>(kTreeQuantum);
            surface.push_back(face.error <= tolerance ? d - e : kInfinity);
            if (face.error <= tolerance)
            {
                const double sq = closest_point_on_triangle(center, triangle).distance_sq;
                if (sq < least_sq || (sq == least_sq && face.face < nearest))
                {
                    least_sq = sq;
                    nearest = face.face;
                }
            }
            double& least = face.error == 0           ? exact_lower
                            : face.error <= tolerance ? tolerated_lower
                                                      : coarse_lower;
            least = std::min(least, d - e);
            if (face.error == 0)
            {
                upper = std::min(upper, d);
                continue;
            }
            for (const Vec3& corner : triangle)
            {
                upper = std::min(upper, (corner - center).norm());
            }
        }
        lower = std::max(0.0, std::min({exact_lower, tolerated_lower, coarse_lower}));
    }
};

struct PointAnswer
{
    std::unique_ptr<OwnedSurface> surface{std::make_unique<OwnedSurface>()};
    WalkBudget budget;
};

PointAnswer ask(const AbTree& tree, const Vec3& center, double reach,
                std::uint32_t nodes = 1'000'000, std::uint32_t triangles = 1'000'000,
                ErrorCode tolerance = 0, std::size_t room = kMaxLocalTriangles)
{
    PointAnswer asked;
    asked.surface->triangles = asked.surface->triangles.first(room);
    asked.surface->distances_m = asked.surface->distances_m.first(room);
    asked.budget = {nodes, triangles};
    QueryMemory memory;
    gather_surface(tree, center, reach, memory, asked.budget, *asked.surface, ProofShare::most,
                   tolerance);
    return asked;
}

/// Expects all faces of the surface within the certified radius in the list, and no coarse face in
/// it.
void expect_certified(const AbTree& tree, const LocalSurface& surface,
                      std::span<const ChangedFace> faces, const PointTruth& truth)
{
    const double radius = surface.answer.certified_radius_m;
    if (radius > 0.0)
    {
        ASSERT_LE(radius, std::max(0.0, truth.coarse_lower));
    }
    const auto listed = faces_of(tree, surface);
    for (std::size_t i = 0; i < faces.size(); ++i)
    {
        if (truth.surface[i] < radius - kSlack)
        {
            ASSERT_EQ(listed.count(faces[i].face.value), 1U) << faces[i].face.value;
        }
    }
}

void fill(TreeRig& rig, Random& random, const FaceStyle& style, std::uint32_t count,
          bool exact_only)
{
    const std::uint32_t step = count % 37 == 0 ? 41 : 37; // Coprime: each face occurs once.
    for (std::uint32_t prim = 0; prim < count; ++prim)
    {
        ChangedFace face = random_face(random, style, prim, (prim * step) % count);
        face.error = exact_only ? 0 : face.error;
        rig.put(face);
    }
    rig.sut->refit();
}

Vec3 random_center(Random& random)
{
    return {random.between(-2.5, 2.5), random.between(-1.0, 1.5), random.between(-1.0, 1.5)};
}

} // namespace

TEST(SurfaceQuery, an_empty_tree_is_free_space)
{
    TreeRig rig({4, 64, 64});

    const PointAnswer asked = ask(*rig.sut, Vec3(0, 0, 0), 1.0);

    EXPECT_EQ(asked.surface->answer.kind, AnswerKind::separated);
    EXPECT_EQ(asked.surface->count, 0U);
    EXPECT_EQ(asked.surface->answer.certified_radius_m, 1.0);
    EXPECT_TRUE(asked.surface->answer.nearest_face.is_none());
}

TEST(SurfaceQuery, equals_brute_force_in_every_style)
{
    Random random(40);
    for (const FaceStyle& style : face_styles())
    {
        for (const bool exact_only : {false, true})
        {
            SCOPED_TRACE(std::string(style.name) + (exact_only ? ", exact only" : ""));
            TreeRig rig({300, 400, 400});
            fill(rig, random, style, 300, exact_only);
            const auto faces = rig.present();
            for (int i = 0; i < 150; ++i)
            {
                SCOPED_TRACE(i);
                const Vec3 center = random_center(random);
                const double reach = random.between(0.0, 0.4);
                const PointTruth truth(faces, center);
                const PointAnswer asked = ask(*rig.sut, center, reach);
                const DistanceAnswer& answer = asked.surface->answer;
                // Single precision's bounds suffice beyond the reach, and for coarse faces.
                const bool is_exact = answer.kind == AnswerKind::exact;
                const double slack = is_exact ? kSlack : kFilterSlack;
                const double proven = truth.upper > reach
                                          ? static_cast<double>(kProofShare) * truth.upper
                                          : kInfinity;
                ASSERT_GE(answer.lower_m, std::min(truth.lower, proven) - slack);
                ASSERT_LE(answer.upper_m * (is_exact ? 1.0 : static_cast<double>(kProofShare)),
                          truth.upper + slack);
                ASSERT_LE(answer.lower_m, truth.lower);
                ASSERT_GE(answer.upper_m, truth.upper);
                ASSERT_NO_FATAL_FAILURE(expect_certified(*rig.sut, *asked.surface, faces, truth));
                if (exact_only)
                {
                    ASSERT_EQ(answer.kind,
                              truth.lower > reach ? AnswerKind::separated : AnswerKind::exact);
                    if (is_exact)
                    {
                        ASSERT_EQ(answer.nearest_face, truth.nearest);
                        ASSERT_NEAR((answer.nearest_point_m - center).norm(), truth.upper, kSlack);
                    }
                    ASSERT_EQ(answer.certified_radius_m,
                              asked.surface->truncated ? answer.certified_radius_m : reach);
                }
            }
        }
    }
}

TEST(SurfaceQuery, takes_faces_within_the_tolerance_for_the_surface)
{
    Random random(48);
    int exact = 0;
    int tolerated = 0;
    int open = 0;
    for (const FaceStyle& style : face_styles())
    {
        SCOPED_TRACE(style.name);
        for (int tree = 0; tree < 6; ++tree)
        {
            TreeRig rig({300, 400, 400});
            fill(rig, random, style, 300, false);
            const auto faces = rig.present();
            for (int i = 0; i < 100; ++i)
            {
                SCOPED_TRACE("tree " + std::to_string(tree) + ", query " + std::to_string(i));
                const Vec3 center = random_center(random);
                const double reach = random.between(0.0, 0.6);
                const ErrorCode tolerance = large_error(random, faces);
                const double tolerance_m = static_cast<double>(error_in_quanta(tolerance)) *
                                           static_cast<double>(kTreeQuantum);
                const std::size_t room =
                    random.one_in(3) ? 1 + random.below(10) : kMaxLocalTriangles;
                const PointTruth truth(faces, center, tolerance);
                const PointAnswer asked =
                    ask(*rig.sut, center, reach, 1'000'000, 1'000'000, tolerance, room);
                const DistanceAnswer& answer = asked.surface->answer;
                ASSERT_LE(answer.lower_m, truth.lower + kSlack);
                ASSERT_GE(answer.upper_m, truth.upper - kSlack);
                ASSERT_LE(answer.tolerated_m, tolerance_m);
                ASSERT_NO_FATAL_FAILURE(expect_certified(*rig.sut, *asked.surface, faces, truth));
                const double known = std::min(truth.exact_lower, truth.tolerated_lower);
                // A full list reduces the known range, which is still true.
                if (!asked.surface->truncated && known > 0.0 &&
                    known < std::min(truth.coarse_lower, reach) - kFilterSlack)
                {
                    ASSERT_TRUE(is_known(answer.kind));
                    ASSERT_NEAR(answer.lower_m, known, kSlack);
                }
                if (!asked.surface->truncated && is_known(answer.kind) &&
                    std::abs(truth.exact_lower - truth.tolerated_lower) > kSlack)
                {
                    ASSERT_EQ(answer.kind == AnswerKind::exact,
                              truth.exact_lower < truth.tolerated_lower);
                    ASSERT_EQ(answer.nearest_face, truth.nearest);
                }
                exact += answer.kind == AnswerKind::exact ? 1 : 0;
                tolerated += answer.kind == AnswerKind::within_tolerance ? 1 : 0;
                open += answer.kind == AnswerKind::bounded ? 1 : 0;
            }
        }
    }
    EXPECT_GT(exact, 50);
    EXPECT_GT(tolerated, 10);
    EXPECT_GT(open, 200);
}

TEST(SurfaceQuery, is_true_when_the_reach_ends_just_before_the_surface)
{
    Random random(47);
    for (const FaceStyle& style : face_styles())
    {
        for (int tree = 0; tree < 20; ++tree)
        {
            TreeRig rig({300, 400, 400});
            fill(rig, random, style, 300, false);
            const auto faces = rig.present();
            for (int i = 0; i < 30; ++i)
            {
                const Vec3 center = random_center(random);
                const PointTruth truth(faces, center);
                const double reach = random.between(0.85, 1.0) * truth.upper;
                const DistanceAnswer answer = ask(*rig.sut, center, reach).surface->answer;
                ASSERT_LE(answer.lower_m, truth.lower) << style.name << " " << tree << " " << i;
                ASSERT_GE(answer.upper_m, truth.upper) << style.name << " " << tree << " " << i;
            }
        }
    }
}

TEST(SurfaceQuery, a_nearest_exact_face_is_given_its_lowest_id_among_equals)
{
    TreeRig rig({20, 64, 64});
    for (std::uint32_t prim = 0; prim < 20; ++prim)
    {
        // All faces are the same triangle; ids fall as prims rise, buckets are far apart.
        rig.put({PrimId{prim},
                 FaceId{100 - prim},
                 prim << 27U,
                 0,
                 {{{0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}}}});
    }
    rig.sut->refit();

    const PointAnswer asked = ask(*rig.sut, Vec3(0.2, 0.2, 0.5), 1.0);

    EXPECT_EQ(asked.surface->answer.nearest_face, FaceId{81});
    EXPECT_EQ(asked.surface->count, 20U);
    EXPECT_EQ(asked.surface->answer.kind, AnswerKind::exact);
}

TEST(SurfaceQuery, any_budget_leaves_a_valid_bracket)
{
    Random random(41);
    for (const FaceStyle& style : face_styles())
    {
        SCOPED_TRACE(style.name);
        TreeRig rig({300, 400, 400});
        fill(rig, random, style, 300, false);
        const auto faces = rig.present();
        for (int i = 0; i < 200; ++i)
        {
            SCOPED_TRACE(i);
            const Vec3 center = random_center(random);
            const double reach = random.between(0.0, 0.5);
            const PointTruth truth(faces, center);
            const std::uint32_t nodes = random.below(12);
            const std::uint32_t triangles = random.one_in(2) ? random.below(40) : 1'000;
            const PointAnswer asked = ask(*rig.sut, center, reach, nodes, triangles);
            ASSERT_LE(asked.budget.nodes_visited, nodes);
            ASSERT_LE(asked.budget.triangles_tested, triangles);
            ASSERT_LE(asked.surface->answer.lower_m, truth.lower);
            ASSERT_GE(asked.surface->answer.upper_m, truth.upper);
            ASSERT_NO_FATAL_FAILURE(expect_certified(*rig.sut, *asked.surface, faces, truth));
            if (asked.surface->answer.kind == AnswerKind::separated)
            {
                ASSERT_GT(truth.lower, reach);
            }
        }
    }
}

TEST(SurfaceQuery, no_budget_at_all_proves_nothing)
{
    Random random(42);
    TreeRig rig({100, 200, 200});
    fill(rig, random, face_styles()[0], 100, true);

    for (const auto& [nodes, triangles] : {std::pair{0U, 100U}, std::pair{100U, 0U}})
    {
        SCOPED_TRACE(nodes);
        const PointAnswer asked = ask(*rig.sut, Vec3(0, 3, 0), 0.5, nodes, triangles);
        EXPECT_EQ(asked.surface->count, 0U);
        EXPECT_EQ(asked.surface->answer.lower_m, 0.0);
        EXPECT_LT(asked.surface->answer.certified_radius_m, 0.0);
        EXPECT_EQ(asked.surface->answer.kind, AnswerKind::bounded);
    }
}

TEST(SurfaceQuery, an_incomplete_tree_proves_nothing)
{
    TreeRig rig({300, 30, 30});
    Random random(43);
    fill(rig, random, face_styles()[4], 300, true);
    ASSERT_FALSE(rig.sut->is_complete());

    const PointAnswer asked = ask(*rig.sut, Vec3(0, 0, 0), 0.5);

    EXPECT_EQ(asked.surface->answer.lower_m, 0.0);
    EXPECT_LT(asked.surface->answer.certified_radius_m, 0.0);
    EXPECT_NE(asked.surface->answer.kind, AnswerKind::separated);
}

TEST(SurfaceQuery, more_triangles_than_fit_keep_the_nearest_and_shrink_the_certified_radius)
{
    Random random(44);
    for (int round = 0; round < 20; ++round)
    {
        SCOPED_TRACE("round " + std::to_string(round));
        const std::uint32_t count = kMaxLocalTriangles + (round == 0 ? 1U : random.below(300));
        TreeRig rig({1'400, 1'800, 1'800});
        fill(rig, random, face_styles()[3], count, true);
        const auto faces = rig.present();
        const Vec3 center = random_center(random);
        const PointTruth truth(faces, center);
        std::vector<double> sorted = truth.surface;
        std::sort(sorted.begin(), sorted.end());

        const PointAnswer asked = ask(*rig.sut, center, 100.0);

        const LocalSurface& surface = *asked.surface;
        const bool overflows = count > kMaxLocalTriangles;
        ASSERT_EQ(surface.truncated, overflows);
        ASSERT_LE(surface.count, std::min(count, kMaxLocalTriangles));
        ASSERT_GE(surface.count, overflows ? kMaxLocalTriangles * 7 / 8 : count);
        if (overflows)
        {
            ASSERT_NEAR(surface.answer.certified_radius_m, sorted[surface.count], kFilterSlack);
            ASSERT_LE(surface.answer.certified_radius_m, sorted[surface.count]);
        }
        const auto listed = faces_of(*rig.sut, surface);
        for (std::size_t i = 0; i < faces.size(); ++i)
        {
            const bool is_near = truth.surface[i] < sorted[surface.count - 1] + kFilterSlack;
            ASSERT_TRUE(is_near || listed.count(faces[i].face.value) == 0);
        }
        for (std::uint32_t i = 0; i < surface.count; ++i)
        {
            const auto d = static_cast<double>(
                DistanceOracle::distance(center, to_triangle(surface.triangles[i].corners_m)));
            ASSERT_NEAR(surface.distances_m[i], d, kFilterSlack);
            ASSERT_LE(surface.distances_m[i], d);
        }
    }
}

/// Short list filled with the distances, with elements known by prim.
struct ShortList
{
    ShortList(std::size_t places, const std::vector<double>& distances_m)
        : triangles(places), room(places)
    {
        surface.triangles = triangles;
        surface.distances_m = room;
        NearestTriangles list(surface);
        for (std::uint32_t i = 0; i < distances_m.size(); ++i)
        {
            if (LocalTriangle* const place = list.add(distances_m[i]))
            {
                place->prim = PrimId{i};
            }
        }
        dropped_m = list.dropped_m();
    }

    std::vector<LocalTriangle> triangles;
    std::vector<double> room;
    LocalSurface surface;
    double dropped_m{0.0};
};

TEST(NearestTriangles, are_kept_in_their_order_and_all_that_are_nearer_than_one_that_was_dropped)
{
    Random random(48);
    for (int round = 0; round < 500; ++round)
    {
        SCOPED_TRACE("round " + std::to_string(round));
        const std::size_t places = random.below(40);
        std::vector<double> distances_m(random.below(200));
        for (double& distance_m : distances_m) // Many are equal.
        {
            distance_m = random.below(random.one_in(2) ? 5 : 1'000);
        }
        const ShortList sut(places, distances_m);
        const std::size_t count = sut.surface.count;
        ASSERT_EQ(sut.surface.truncated, distances_m.size() > places);
        ASSERT_LE(count, places);
        ASSERT_GE(count + std::max<std::size_t>(places / 8, 1),
                  std::min(places, distances_m.size()));
        std::size_t nearer = 0;
        for (std::size_t i = 0; i < count; ++i)
        {
            const std::uint32_t prim = sut.triangles[i].prim.value;
            ASSERT_EQ(sut.room[i], distances_m[prim]);
            ASSERT_LE(sut.room[i], sut.dropped_m);
            ASSERT_TRUE(i == 0 || sut.triangles[i - 1].prim.value < prim);
            nearer += sut.room[i] < sut.dropped_m ? 1U : 0U;
        }
        const auto all_nearer = std::ranges::count_if(distances_m, [&](double distance_m)
                                                      { return distance_m < sut.dropped_m; });
        ASSERT_EQ(nearer, static_cast<std::size_t>(all_nearer));
    }
}

/// Small face perpendicular to the direction from the origin, about a metre away.
ChangedFace face_around_origin(Random& random, std::uint32_t prim, bool exact_only)
{
    ChangedFace face{PrimId{prim}, FaceId{prim}, prim / 8, 0, {}};
    const Vec3 way = (random.in_cube(1.0) + Vec3(0.0, 0.0, 1e-3)).normalized();
    for (Vec3f& corner : face.corners_m)
    {
        const Vec3 scaled = way * random.between(0.98, 1.02);
        corner = to_float(scaled + random.in_cube(0.02));
    }
    face.error = exact_only || !random.one_in(3) ? 0 : static_cast<ErrorCode>(1 + random.below(10));
    return face;
}

/// Even bits of a number, adjacent.
std::uint32_t even_bits(std::uint32_t number)
{
    std::uint32_t bits = 0;
    for (std::uint32_t bit = 0; bit < 16; ++bit)
    {
        bits |= (number >> (2 * bit) & 1U) << bit;
    }
    return bits;
}

/// Sheet of small exact faces around the origin, 2 m wide; near ones are near in the tree.
constexpr std::uint32_t kSheetSide = 128;
constexpr std::uint32_t kSheetFaces = kSheetSide * kSheetSide;
void put_sheet(TreeRig& rig)
{
    constexpr double kEdge = 2.0 / kSheetSide;
    for (std::uint32_t i = 0; i < kSheetFaces; ++i)
    {
        const Vec3 at(-1.0 + kEdge * even_bits(i), -1.0 + kEdge * even_bits(i >> 1U), 0.0);
        rig.put(
            {PrimId{i},
             FaceId{i},
             i / 8,
             0,
             {to_float(at), to_float(at + Vec3(kEdge, 0, 0)), to_float(at + Vec3(0, kEdge, 0))}});
    }
    rig.sut->refit();
}

/// Radius of a disc with this number of its faces.
double sheet_disc(double faces)
{
    return std::sqrt(faces * 4.0 / kSheetFaces / std::numbers::pi);
}

TEST(SurfaceQuery, once_the_list_is_full_looks_no_farther_than_what_is_in_it)
{
    TreeRig rig({kSheetFaces, kSheetFaces, kSheetFaces});
    put_sheet(rig);
    const PointAnswer asked = ask(*rig.sut, Vec3(0, 0, 0.1), 2.0);
    EXPECT_TRUE(asked.surface->is_cut);
    EXPECT_GE(asked.surface->count, kMaxLocalTriangles * 7 / 8);
    EXPECT_LT(asked.budget.triangles_tested, kSheetFaces / 2);
    const double disc = sheet_disc(asked.surface->count);
    EXPECT_NEAR(asked.surface->answer.certified_radius_m, std::hypot(disc, 0.1), 0.1 * disc);
}

TEST(SurfaceQuery, what_a_spent_budget_leaves_is_far_away)
{
    TreeRig rig({kSheetFaces, kSheetFaces, kSheetFaces});
    put_sheet(rig);
    for (const std::uint32_t triangles : {1'600U, 3'200U})
    {
        const PointAnswer asked = ask(*rig.sut, Vec3(0, 0, 0), 2.0, 1'000'000, triangles);
        EXPECT_TRUE(asked.surface->is_cut);
        const double half = sheet_disc(0.5 * triangles);
        EXPECT_GT(asked.surface->answer.certified_radius_m, 0.5 * half) << triangles;
        EXPECT_LT(asked.surface->answer.certified_radius_m, 2.0 * half) << triangles;
    }
    EXPECT_FALSE(ask(*rig.sut, Vec3(0, 0, 0), 0.05).surface->is_cut);
}

/// The search then begins at two blocks, both in reach.
TEST(SurfaceQuery, after_a_jump_lists_each_face_once_and_the_same_faces_as_a_first_query)
{
    TreeRig rig({kSheetFaces, kSheetFaces, kSheetFaces});
    put_sheet(rig);
    const double disc = sheet_disc(500.0);
    QueryMemory memory;
    for (int jump = 0; jump < 8; ++jump)
    {
        const Vec3 center(jump % 2 == 0 ? -0.2 * disc : 0.3 * disc, 0.01 * disc * jump, 1e-3);
        const PointAnswer first = ask(*rig.sut, center, disc);
        PointAnswer asked;
        asked.budget = {1'000'000, 1'000'000};
        gather_surface(*rig.sut, center, disc, memory, asked.budget, *asked.surface);
        ASSERT_FALSE(asked.surface->is_cut) << jump;
        ASSERT_EQ(faces_of(*rig.sut, *asked.surface), faces_of(*rig.sut, *first.surface)) << jump;
        ASSERT_EQ(asked.surface->count, first.surface->count) << jump;
        ASSERT_EQ(asked.surface->answer.nearest_face, first.surface->answer.nearest_face) << jump;
    }
}

TEST(SurfaceQuery, of_more_nodes_and_blocks_than_are_gone_through_in_order_misses_none)
{
    constexpr std::uint32_t kFaces = 12'000;
    Random random(47);
    for (const bool exact_only : {true, false})
    {
        TreeRig rig({kFaces, kFaces, kFaces});
        for (std::uint32_t prim = 0; prim < kFaces; ++prim)
        {
            rig.put(face_around_origin(random, prim, exact_only));
        }
        rig.sut->refit();
        ASSERT_GT(rig.sut->nodes_used() + rig.sut->blocks_used(), 4 * Frontier::kBroad);
        for (int i = 0; i < 10; ++i)
        {
            const Vec3 center = random.in_cube(0.05);
            const PointTruth truth(rig.present(), center);
            WalkBudget budget{1'000'000, 1'000'000};
            QueryMemory memory;

            const DistanceAnswer answer =
                query_distance(*rig.sut, center, kInfinity, memory, budget);

            ASSERT_LE(answer.lower_m, truth.lower + kSlack) << i;
            ASSERT_GE(answer.lower_m, truth.lower - kFilterSlack) << i;
            ASSERT_GE(answer.upper_m, truth.upper - kSlack) << i;
            if (exact_only)
            {
                ASSERT_LE(answer.upper_m - answer.lower_m, kSlack) << i;
                ASSERT_EQ(answer.nearest_face, truth.nearest) << i;
                ASSERT_GT(budget.nodes_visited, Frontier::kBroad) << i;
            }
        }
    }
}

TEST(TreeWalk, visits_exactly_the_coarse_blocks_when_asked_for_coarse_ones)
{
    Random random(45);
    TreeRig rig({300, 400, 400});
    fill(rig, random, face_styles()[0], 300, false);
    ASSERT_FALSE(rig.sut->root().is_block());
    std::set<std::uint32_t> expected;
    for (const ChangedFace& face : rig.present())
    {
        if (face.error != 0)
        {
            expected.insert(rig.sut->leaf_of(face.prim) / kBlockFaces);
        }
    }
    WalkBudget budget{10'000};
    const KernelProbe probe = make_probe(Vec3(0, 0, 0), kTreeQuantum);
    TreeWalk sut(*rig.sut, probe, budget);

    std::set<std::uint32_t> visited;
    for (std::uint32_t block = sut.next_block(kInfiniteQuanta, true); block != kNoNode;
         block = sut.next_block(kInfiniteQuanta, true))
    {
        EXPECT_TRUE(visited.insert(block).second);
    }

    EXPECT_EQ(visited, expected);
    EXPECT_TRUE(sut.left().empty());
}

/// Face of this path (AbTree), with separate corners.
ChangedFace face_of_path(std::uint32_t prim, std::uint64_t path, float x)
{
    // A face's path is its bucket, and its id times an odd number, of which this is the inverse.
    constexpr std::uint32_t kFactor = 0x9E37'79B9U;
    std::uint32_t inverse = 1;
    for (int i = 0; i < 5; ++i) // Newton's iteration: each round doubles the right bits.
    {
        inverse *= 2U - kFactor * inverse;
    }
    const auto own = static_cast<float>(prim);
    return {PrimId{prim},
            FaceId{static_cast<std::uint32_t>(path >> 1U) * inverse},
            static_cast<std::uint32_t>(path >> 33U),
            0,
            {{{x, own, 0.0F}, {x + 0.5F, own, 0.0F}, {x, own, 0.5F}}}};
}

TEST(TreeWalk, of_the_deepest_tree_leaves_no_more_on_its_stack_than_the_limit)
{
    constexpr std::uint32_t kFaces = 5; // Faces of separate corners, as many as fit into a block.
    constexpr std::uint32_t kTopShift = 3 * (kTreeLevels - 1);
    TreeRig rig({1'000, 1'000, 1'000});
    std::uint32_t prim = 0;
    const auto add_block = [&](std::uint64_t path, std::uint32_t faces, float x)
    {
        for (std::uint64_t i = 0; i < faces; ++i, ++prim)
        {
            rig.put(face_of_path(prim, path | (i << 1U), x));
        }
    };
    // Every digit from the root to the last but one is a zero with all other digits beside it.
    for (std::uint32_t shift = kTopShift; shift >= 3; shift -= 3)
    {
        for (std::uint64_t digit = 1; digit < (shift == kTopShift ? 2 : 8); ++digit)
        {
            add_block(digit << shift, shift == 3 ? 4 : kFaces, 1'000.0F);
        }
    }
    add_block(0, 4, 0.0F);
    rig.sut->refit();
    ASSERT_EQ(rig.faults(), "");
    std::uint32_t levels = 0;
    for (std::uint32_t node =
             rig.sut->side(rig.sut->leaf_of(PrimId{prim - 1}) / kBlockFaces).parent;
         node != kNoNode; node = rig.sut->node(node).parent)
    {
        ++levels;
    }
    EXPECT_EQ(levels, kTreeLevels - 1) << "the last digit has too few faces for a node";

    const KernelProbe probe = make_probe(Vec3(0, 0, 0), kTreeQuantum);
    std::size_t deepest = 0;
    for (std::uint32_t nodes = 0; nodes <= levels; ++nodes)
    {
        WalkBudget budget{nodes};
        TreeWalk sut(*rig.sut, probe, budget);
        EXPECT_EQ(sut.next_block(kInfiniteQuanta, false), kNoNode);
        deepest = std::max(deepest, sut.left().size());
    }

    EXPECT_LE(deepest, kTreeStack);
    // The path's highest digit has one bit, and the lowest is in blocks.
    EXPECT_EQ(deepest, kTreeStack - 6 - 2 * 7);
}

TEST(TreeWalk, leaves_out_only_blocks_beyond_the_bound)
{
    Random random(46);
    TreeRig rig({300, 400, 400});
    fill(rig, random, face_styles()[3], 300, true);
    const auto faces = rig.present();
    for (int i = 0; i < 100; ++i)
    {
        const Vec3 center = random_center(random);
        const double bound = random.between(0.0, 1.0);
        WalkBudget budget{10'000};
        const KernelProbe probe = make_probe(center, kTreeQuantum);
        const auto quanta = static_cast<float>(bound / static_cast<double>(kTreeQuantum));
        TreeWalk sut(*rig.sut, probe, budget);
        std::set<std::uint32_t> visited;
        for (std::uint32_t block = sut.next_block(quanta, false); block != kNoNode;
             block = sut.next_block(quanta, false))
        {
            visited.insert(block);
        }
        for (const ChangedFace& face : faces)
        {
            const auto d =
                static_cast<double>(DistanceOracle::distance(center, to_triangle(face.corners_m)));
            if (d < bound)
            {
                ASSERT_EQ(visited.count(rig.sut->leaf_of(face.prim) / kBlockFaces), 1U);
            }
        }
    }
}

} // namespace tactus::test
