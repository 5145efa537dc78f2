// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/records/changed_face.hpp"
#include "tests/bench/bench_row.hpp"
#include "tests/bench/least_times.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/scenes.hpp"
#include "tests/shared/random.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

/// Local changes of a tree of any volume, at places distributed over a surface, and the refit after
/// each.
namespace tactus::bench
{

inline constexpr std::size_t kPlaces = 100;
inline constexpr std::uint32_t kClusteredFaces = 64;
/// Error code that faces change to and back from, so that their boxes grow and shrink.
inline constexpr ErrorCode kChangedError = 8;

/// The `count` items nearest to a point, with positions by `place_of`.
template <typename Item, typename PlaceOf>
[[nodiscard]] std::vector<Item> nearest_items(const std::vector<Item>& items, const Vec3& point_m,
                                              std::size_t count, const PlaceOf& place_of)
{
    std::vector<std::pair<double, std::size_t>> ranked;
    for (std::size_t i = 0; i < items.size(); ++i)
    {
        ranked.emplace_back((place_of(items[i]) - point_m).squaredNorm(), i);
    }
    count = std::min(count, ranked.size());
    std::nth_element(ranked.begin(), ranked.begin() + static_cast<std::ptrdiff_t>(count) - 1,
                     ranked.end());
    std::vector<Item> nearest;
    for (std::size_t i = 0; i < count; ++i)
    {
        nearest.push_back(items[ranked[i].second]);
    }
    return nearest;
}

struct ChangeTimes
{
    LeastTimes refit_us{kPlaces};
    LeastTimes all_us{kPlaces};
    std::uint64_t nodes{0}; ///< Refitted blocks and nodes, in total.
};

/// Times `change(there)` with its refit, there and back, `passes` times.
template <typename Tree, typename Change>
void time_change(Tree& tree, std::size_t place, std::uint32_t passes, ChangeTimes& times,
                 const Change& change)
{
    for (std::uint32_t i = 0; i < 2 * passes; ++i)
    {
        const BenchClock::time_point start = BenchClock::now();
        change(i % 2 == 0);
        const BenchClock::time_point changed = BenchClock::now();
        const typename Tree::RefitWork work = tree.refit();
        const BenchClock::time_point end = BenchClock::now();
        times.refit_us.keep(place, microseconds(changed, end));
        times.all_us.keep(place, microseconds(start, end));
        times.nodes += work.blocks + work.nodes;
    }
}

/// Points of the surface, evenly distributed over the order of its faces.
[[nodiscard]] inline std::vector<Vec3> places_on(const Scene& scene)
{
    std::vector<Vec3> places;
    for (std::size_t i = 0; i < kPlaces; ++i)
    {
        const std::size_t face = test::mixed(kSeed, i) % scene.model.faces.size();
        places.push_back(to_vec3(scene.model.faces[face][0]));
    }
    return places;
}

/// Changes the error of the nearest `prims` at each place, and back. `corner_of` returns a prim's
/// first corner.
template <typename Tree, typename CornerOf>
[[nodiscard]] ChangeTimes time_clustered_faces(Tree& tree, const std::vector<PrimId>& prims,
                                               const std::vector<Vec3>& places,
                                               std::uint32_t passes, const CornerOf& corner_of)
{
    ChangeTimes times;
    for (std::size_t place = 0; place < places.size(); ++place)
    {
        const auto cluster = nearest_items(prims, places[place], kClusteredFaces,
                                           [&](PrimId prim) { return to_vec3(corner_of(prim)); });
        std::vector<Vec3f> corners;
        for (const PrimId prim : cluster)
        {
            corners.push_back(corner_of(prim));
        }
        const auto change = [&](bool there)
        {
            for (std::size_t i = 0; i < cluster.size(); ++i)
            {
                tree.move_corner(cluster[i], 0, corners[i], there ? kChangedError : ErrorCode{0});
            }
        };
        time_change(tree, place, passes, times, change);
    }
    return times;
}

} // namespace tactus::bench
