// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/scenes.hpp"
#include "transport/store/model_store.hpp"

#include <cstdint>

namespace tactus::bench
{

/// Cost of one record on the transport thread: the least of several passes over a whole model.
struct ReadingSpeed
{
    double parse_ns{0.0};
    double link_ns{0.0};
    double both_ns{0.0}; ///< Parsing and linking in one pass: not exactly the sum of the others.
};

/// Parses all chunks of a model, then links all pages, on the calling thread, `passes` times. The
/// coded bytes are in memory and their hashes already checked. A failure if a record does not link
/// or the model has none. 150 B a face.
[[nodiscard]] ReadingSpeed measure_reading(const ModelStore& store, std::uint32_t passes);

} // namespace tactus::bench
