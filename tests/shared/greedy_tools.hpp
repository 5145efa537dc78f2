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

/// What the others of a scene do while one tool slides in contact at 0.5 diagonals a second.
struct GreedyCase
{
    enum class Others : std::uint8_t
    {
        none,
        pass,     ///< Slide as fast as they like, through everything.
        teleport, ///< Somewhere else every ten frames.
        are_held, ///< Slide, and the surface holds them back.
    };

    const char* name{""};
    Others others{Others::none};
    double hands_diag_per_s{0.0};
    double follow_m_per_s{0.0}; ///< Of tools that are held.
    std::uint32_t splits{64};
    std::size_t pool_bytes{std::size_t{8} << 20U};
    bool all_resident{false}; ///< Every chunk is here before the first frame.
    std::uint32_t tools{3};   ///< The others. Each slides over an object of its own if it can;
                              ///< one that teleports comes to any.
    std::uint32_t models{1};  ///< All of the same shape.
    /// On a square grid; they show the models in turn. The first tool slides over the first.
    std::uint32_t objects{1};
};

/// The cases of docs/benchmarks.md.
[[nodiscard]] const std::vector<GreedyCase>& greedy_cases();

/// What became of the first tool while its hand is in the surface.
struct GreedyFigures
{
    std::uint32_t frames{0};     ///< In which its hand is in the surface.
    std::uint32_t exact{0};      ///< Of those, with an exact answer.
    std::uint32_t held_back{0};  ///< Of those, held back for want of data.
    double force_step_n{0.0};    ///< The largest from one frame to the next.
    std::uint32_t shed{0};       ///< Frames in which another tool's pair had to wait.
    std::uint32_t full{0};       ///< Frames in which some page or face found no room.
    std::uint32_t splits_max{0}; ///< Of a frame, all tools.
    std::string broken;          ///< A budget or bound that did not hold; empty: none.

    [[nodiscard]] double exact_percent() const { return percent(exact); }
    [[nodiscard]] double held_back_percent() const { return percent(held_back); }

private:
    [[nodiscard]] double percent(std::uint32_t count) const
    {
        return frames == 0 ? 0.0 : 100.0 * count / frames;
    }
};

/// Half a second of lead, then `frames` that count. The model should have some 200,000 faces.
[[nodiscard]] GreedyFigures run_greedy(const TestModel& model, const GreedyCase& greedy,
                                       std::uint32_t frames, std::uint64_t seed);

} // namespace tactus::test
