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

/// Visits cuts of a file: `count` of its simplification, from the base mesh to the source, with
/// even steps of the ratio of faces; then as many random ones that respect the dependencies, every
/// other one with all its splits around one place. Stops if a visit returns false.
void visit_cuts(const EncodedModel& model, std::uint32_t count, std::uint64_t seed,
                const std::function<bool(const CertifiedCut& cut, const std::string& name)>& visit);

/// Expects for each of the cuts that the file's bounds cover `points` new points of the source; and
/// for some cut that bounds a fifth smaller would not, nor zero bounds.
void expect_sound_bounds(const EncodedModel& model, std::uint32_t count, std::size_t points,
                         std::uint64_t seed);

} // namespace tactus::test
