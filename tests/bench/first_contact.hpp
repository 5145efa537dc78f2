// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/encode/decoded_model.hpp"
#include "tests/shared/brute_force.hpp"
#include "tests/shared/face_tree.hpp"
#include "transport/store/model_store.hpp"

#include <cstdint>
#include <vector>

namespace tactus::bench
{

/// Distribution of a figure over the contacts.
struct ContactSpread
{
    double p50{0.0};
    double p90{0.0};
    double max{0.0};
};
[[nodiscard]] ContactSpread contact_spread_of(const std::vector<double>& values);

/// Cost of a file until the first contact is exact, for a controller that has none of it. Counts
/// coded bytes with checksums, without protocol headers.
///
/// A contact is exact if every source face within `radius_m` of a place on the surface is active:
/// the sphere is certified, as a frame certifies it around the proxy. This needs the whole header,
/// the base mesh, the index pages whose boxes meet the sphere, and the chunks whose influence boxes
/// do.
struct FirstContactFigures
{
    double header_bytes{0.0}; ///< Bytes without hashes.
    double base_bytes{0.0};
    ContactSpread index_bytes;      ///< Bytes without hashes.
    ContactSpread chunk_bytes;      ///< Bytes of chunks, which contain no hashes.
    ContactSpread all_bytes;        ///< Bytes without hashes.
    ContactSpread all_hashed_bytes; ///< Bytes with the hashes of header and fetched index pages.
    ContactSpread chunks;           ///< Number of chunks.
    ContactSpread needed_bytes;     ///< Bytes of chunks with a record that is split.
    ContactSpread splits;           ///< Splits from the base mesh until the sphere is certified.
    std::uint64_t missed_chunks{0}; ///< Needed chunks that the index does not name: always 0.
};

/// Measures `contacts` places, distributed by area of the source, with `radius_m`. Two milliseconds
/// each, and on large models as much for each million faces.
[[nodiscard]] FirstContactFigures measure_first_contact(const ModelStore& store,
                                                        const DecodedModel& model,
                                                        const std::vector<test::Face>& source,
                                                        double radius_m, std::uint32_t contacts,
                                                        std::uint64_t seed);

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
