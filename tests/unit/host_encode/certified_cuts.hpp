// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/shared/certified_cut.hpp"
#include "tests/unit/host_encode/encoded_model.hpp"

#include <cstdint>
#include <functional>
#include <string>

namespace tactus::test
{

/// Visits cuts of a file: `count` that its simplification went through, from the base mesh to the
/// source, with even steps of the faces' ratio; then as many random ones that obey the
/// dependencies, every other with all its splits round one place. Ends when a visit returns false.
void visit_cuts(const EncodedModel& model, std::uint32_t count, std::uint64_t seed,
                const std::function<bool(const CertifiedCut& cut, const std::string& name)>& visit);

/// Two expectations. In each of the cuts, `points` new points of the source are all covered by the
/// bounds that the file has; and in some cut bounds a fifth smaller would not cover them, nor would
/// no bounds at all.
void expect_sound_bounds(const EncodedModel& model, std::uint32_t count, std::size_t points,
                         std::uint64_t seed);

} // namespace tactus::test
