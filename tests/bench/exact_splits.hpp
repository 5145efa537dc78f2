// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/decoded_model.hpp"
#include "tests/bench/first_contact.hpp"
#include "tests/shared/face_tree.hpp"

#include <cstdint>
#include <vector>

namespace tactus::bench
{

/// Splits from the base mesh that the certificate requests until a distance is exact.
struct ExactSplits
{
    ContactSpread splits;
    /// Greatest error of the answers against the source: rounding only.
    double distance_error_max_m{0.0};
};

/// Requests the distances of `probes` places, each up to two radii from a place of the source in
/// any direction. `tree` is the source's. About 0.3 ms each, and 2 ms for each million faces.
[[nodiscard]] ExactSplits measure_exact_splits(const DecodedModel& model,
                                               const std::vector<test::Face>& source,
                                               const test::FaceTree& tree, double radius_m,
                                               std::uint32_t probes, std::uint64_t seed);

} // namespace tactus::bench
