// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/stability/whole_model.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace tactus::test
{

namespace
{

constexpr std::uint32_t kFillingMax = 20'000;

} // namespace

RigOptions whole_options(std::size_t faces)
{
    RigOptions options;
    options.pool_bytes = (std::size_t{16} << 20U) + 512 * faces;
    options.static_when_it_fits = true;
    options.chunk_loader_steps_per_frame = 16;
    return options;
}

void refine_fully(const std::string& name,
                  const std::function<FrameOutput(const Budgets& budgets)>& step)
{
    Budgets budgets;
    budgets.splits = kMaxSplitsPerFrame;
    budgets.pages = kMaxArrivalsPerFrame;
    budgets.requests = 64;
    for (std::uint32_t frame = 0; frame < kFillingMax; ++frame)
    {
        if (std::ranges::all_of(step(budgets).models, &ModelOutput::is_static))
        {
            return;
        }
    }
    std::fprintf(stderr, "%s is not refined fully after %u frames\n", name.c_str(), kFillingMax);
    std::exit(2);
}

} // namespace tactus::test
