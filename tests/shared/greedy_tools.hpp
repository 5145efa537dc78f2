// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/frame_rig.hpp"
#include "tests/shared/test_model.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tactus::test
{

/// Behaviour of the other tools while one slides in contact at 0.5 diagonals a second.
struct GreedyCase
{
    enum class Others : std::uint8_t
    {
        none,
        pass,     ///< Slide at any speed through everything.
        teleport, ///< Jump elsewhere every ten frames.
        are_held, ///< Slide with a proxy on the surface.
    };

    const char* name{""};
    Others others{Others::none};
    double operators_diag_per_s{0.0};
    double follow_m_per_s{0.0}; ///< Proxy speed limit.
    std::uint32_t splits{64};
    std::size_t pool_bytes{std::size_t{8} << 20U};
    bool all_resident{false}; ///< True if every chunk is resident before the first frame.
    /// Other tools. Each slides over its own object if possible; a teleporting one visits any.
    std::uint32_t tools{3};
    std::uint32_t models{1}; ///< Models, all of the same shape.
    /// Objects on a square grid, which show the models in turn. The first tool slides over the
    /// first.
    std::uint32_t objects{1};
};

/// Cases of docs/benchmarks/scenes.md.
[[nodiscard]] const std::vector<GreedyCase>& greedy_cases();

/// Figures of the first tool while its hand is in the surface.
struct GreedyFigures
{
    std::uint32_t frames{0};       ///< Frames with the hand in the surface.
    std::uint32_t exact{0};        ///< Frames of these with an exact answer.
    std::uint32_t data_limited{0}; ///< Frames of these that are data-limited.
    double force_step_n{0.0};      ///< Greatest change of the force between frames.
    std::uint32_t shed{0};         ///< Frames in which another tool's pair had to wait.
    std::uint32_t full{0};         ///< Frames in which a pool was full.
    std::uint32_t splits_max{0};   ///< Most splits of a frame, all tools together.
    std::string broken;            ///< Budget or bound that did not hold; empty: none.

    [[nodiscard]] double exact_percent() const { return percent(exact); }
    [[nodiscard]] double data_limited_percent() const { return percent(data_limited); }

private:
    [[nodiscard]] double percent(std::uint32_t count) const
    {
        return frames == 0 ? 0.0 : 100.0 * count / frames;
    }
};

/// Runs half a second of lead, then `frames` that count. The model should have about 200,000 faces.
[[nodiscard]] GreedyFigures run_greedy(const TestModel& model, const GreedyCase& greedy,
                                       std::uint32_t frames, std::uint64_t seed);

} // namespace tactus::test
