// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace tactus
{

/// Calls work(worker, begin, end) for consecutive blocks that cover 0 .. count - 1, on `threads`
/// threads, the caller's included. The assignment of blocks to workers is arbitrary: results must
/// not depend on it. Each call starts its own threads; simplify() calls it only a few times a
/// round.
template <typename Work>
void parallel_blocks(unsigned threads, std::size_t count, std::size_t block, const Work& work)
{
    std::atomic<std::size_t> next{0};
    const auto run = [&](unsigned worker)
    {
        for (std::size_t begin = next.fetch_add(block); begin < count;
             begin = next.fetch_add(block))
        {
            work(worker, begin, std::min(begin + block, count));
        }
    };
    std::vector<std::jthread> helpers;
    for (unsigned worker = 1; worker < threads && worker * block < count; ++worker)
    {
        helpers.emplace_back(run, worker);
    }
    run(0);
}

} // namespace tactus
