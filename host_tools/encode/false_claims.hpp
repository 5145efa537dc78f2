// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/decoded_model.hpp"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

// Any thread, but not the haptic one: it allocates, and waits for the file.
namespace tactus
{

struct ClaimCheck
{
    /// Places of the source that are held against the error bounds of each of some ten cuts, coarse
    /// to fine. Evenly over the faces; the same in each call.
    std::size_t places{2'000};
    /// Called after each record with how many are done; twice round.
    std::function<void(std::size_t done)> progress = [](std::size_t) {};
};

struct ClaimsFound
{
    std::string contradiction; ///< Empty, or why the records can't all be split; then no claims.
    /// What the model says of itself and isn't so, a line each: what, where, and what it is.
    std::vector<std::string> false_claims;
};

/// Refines a decoded model wholly and computes anew what its file claims: faces and vertices,
/// whether it is closed, its extent, the largest depth and error bound, regions, influence boxes of
/// chunks and pages, buckets; and holds the source against error bounds, by samples: a false bound
/// may be missed, a true one is never called false. What only the author knows can't be checked:
/// what the mesh was before it was put on the grid. Some 3 us and 100 B a face.
[[nodiscard]] ClaimsFound find_false_claims(const ModelStore& store, const DecodedModel& model,
                                            const ClaimCheck& check = {});

} // namespace tactus
