// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Suite `peers`: the same work for our queries and for those of alternative libraries. Without
/// peers in the build, ours alone.

#include "tests/bench/peer_cases.hpp"
#include "tests/bench/suites.hpp"

namespace tactus::bench
{

namespace
{

std::vector<Case> peers_cases()
{
    const auto touch =
        [](const char* name, When when, const SceneSource& scene, std::size_t pool_bytes)
    {
        return make_case(name, when, run_peer_touch_case,
                         PeerTouchCase{"W1, touch", scene, "", pool_bytes});
    };
    const auto mesh = [](const char* name, When when, const SceneSource& scene)
    { return make_case(name, when, run_peer_mesh_case, PeerMeshCase{scene}); };
    const auto scale = [](const char* name, When when, std::uint32_t faces, const char* setting)
    {
        const SceneSource sphere{name, nullptr, 0, faces};
        return make_case(name, when, run_peer_touch_case,
                         PeerTouchCase{"W3, scale", sphere, setting, std::nullopt});
    };
    return {
        touch("touch-bunny", When::always, kBunny, 2 * kMiB),
        touch("touch-igea", When::full_only, kIgea, 4 * kMiB),
        mesh("mesh-bunny", When::always, kBunny),
        mesh("mesh-igea", When::full_only, kIgea),
        mesh("mesh-1.1M", When::full_only, kFineBunny),
        scale("scale-4k", When::always, 4'000, "4 k faces"),
        scale("scale-40k", When::always, 40'000, "40 k faces"),
        scale("scale-400k", When::full_only, 400'000, "400 k faces"),
        scale("scale-4M", When::full_only, 4'000'000, "4 M faces"),
        touch("touch-tiny", When::named_only, kTiny, kMiB),
        mesh("mesh-tiny", When::named_only, kTiny),
        scale("scale-tiny", When::named_only, 2'000, "2 k faces"),
    };
}

} // namespace

Suite peers_suite()
{
    return {"peers", peers_cases};
}

} // namespace tactus::bench
