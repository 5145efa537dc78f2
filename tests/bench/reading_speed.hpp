// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/scenes.hpp"
#include "transport/store/model_store.hpp"

#include <cstdint>

namespace tactus::bench
{

/// What one record costs the transport thread, the least of some passes over a whole model.
struct ReadingSpeed
{
    double parse_ns{0.0};
    double link_ns{0.0};
    double both_ns{0.0}; ///< Of one pass: not quite the sum of the others.
};

/// Parses all chunks of a model, then links all pages, on the calling thread, `passes` times. The
/// coded bytes lie in memory; hashes were checked before. A failure when a record doesn't link and
/// when the model has none. 150 B a face.
[[nodiscard]] ReadingSpeed measure_reading(const ModelStore& store, std::uint32_t passes);

} // namespace tactus::bench
