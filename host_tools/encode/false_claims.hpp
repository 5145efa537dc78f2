// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/decoded_model.hpp"

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

// Any thread, except the haptic one: it allocates, and waits for the file.
namespace tactus
{

/// Effort of a check of claims.
struct ClaimCheck
{
    /// Number of points of the source that are checked against the error bounds in each of some ten
    /// cuts, coarse to fine. They are spread evenly over the faces and deterministic.
    std::size_t places{2'000};
    /// Callback after each split with the number of splits so far: at most 1.5 times the number of
    /// records.
    std::function<void(std::size_t done)> progress = [](std::size_t) {};
};

/// Result of a check of claims.
struct ClaimsFound
{
    /// Reason why a record cannot be split; `false_claims` is then empty. Empty if all can be
    /// split.
    std::string contradiction;
    /// Claims of the model that are false, one line each: the claim, its place and the true value.
    std::vector<std::string> false_claims;
};

/// Refines a decoded model completely and recomputes the claims of its file: faces and vertices,
/// whether it is closed, its extent, the largest depth and error bound, regions, influence boxes of
/// chunks and pages, buckets. Error bounds are checked against samples of the source: a false bound
/// may be missed, a true one is never reported. Rounding to the grid cannot be checked, since only
/// the author has the original mesh. About 3 us and 100 B a face.
[[nodiscard]] ClaimsFound find_false_claims(const ModelStore& store, const DecodedModel& model,
                                            const ClaimCheck& check = {});

} // namespace tactus
