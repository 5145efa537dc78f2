// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/decoded_model.hpp"
#include "tests/shared/brute_force.hpp"
#include "transport/store/model_store.hpp"

#include <cstdint>
#include <vector>

namespace tactus::bench
{

/// How a figure is spread over the contacts.
struct ContactSpread
{
    double p50{0.0};
    double p90{0.0};
    double max{0.0};
};
[[nodiscard]] ContactSpread contact_spread_of(const std::vector<double>& values);

/// What a file costs a controller that knows nothing of it until the first contact is exact,
/// counted at file level: coded bytes, checksums included, protocol headers not.
///
/// A contact is exact when every source face within `radius_m` of a place on the surface is active:
/// the ball is certified, as a frame certifies it round the proxy. It takes the whole header, the
/// base mesh, the index pages whose boxes meet the ball, and the chunks whose influence boxes do.
struct FirstContactFigures
{
    double header_bytes{0.0}; ///< Without hashes.
    double base_bytes{0.0};
    ContactSpread index_bytes;      ///< Without hashes.
    ContactSpread chunk_bytes;      ///< Which have no hashes in them.
    ContactSpread all_bytes;        ///< Without hashes.
    ContactSpread all_hashed_bytes; ///< With those of header and fetched index pages.
    ContactSpread chunks;           ///< How many.
    ContactSpread needed_bytes;     ///< Of the chunks that have a record which is split.
    ContactSpread splits;           ///< From the base mesh until the ball is certified.
    std::uint64_t missed_chunks{0}; ///< Needed, but not named by the index: always 0.
};

/// Measures `contacts` places, evenly by area of the source, with `radius_m`. Two milliseconds each
/// and, on large models, as much for every million of faces.
[[nodiscard]] FirstContactFigures measure_first_contact(const ModelStore& store,
                                                        const DecodedModel& model,
                                                        const std::vector<test::Face>& source,
                                                        double radius_m, std::uint32_t contacts,
                                                        std::uint64_t seed);

} // namespace tactus::bench
