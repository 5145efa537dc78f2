// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/cases.hpp"

#include <cstdint>
#include <functional>
#include <optional>

namespace tactus::bench
{

/// Lines of a mesh that a simplifier should preserve.
enum class Feature : std::uint8_t
{
    none,
    borders,
    sharp_edges,
};

/// Goals of the encoder for one mesh; no goal without a value.
struct EncoderGoals
{
    std::optional<double> rms_to_garland_heckbert; ///< Our error divided by theirs.
    std::optional<double> max_to_garland_heckbert;
    std::optional<double> rms_to_meshoptimizer;
    std::optional<double> us_per_face; ///< Microseconds a face on one core.
    std::optional<double> us_per_face_on_two;
    std::optional<double> seconds; ///< Seconds on one core.
    std::optional<double> peak_bytes_per_face;
    std::optional<double> file_bytes_per_face;      ///< File size at 16 bits, without hashes.
    std::optional<double> fine_file_bytes_per_face; ///< File size at 20 bits.
    std::optional<double> read_ns_per_record;       ///< Parsing and linking on one core.
    std::optional<double> base_faces;
    /// Greatest bound divided by greatest true error, at n/6 faces.
    std::optional<double> bound_at_sixth;
    std::optional<double> bound_at_two_thirds;
    std::optional<double> exact_splits;
    std::optional<double> contact_kb; ///< Data until the first exact contact, without hashes.
    std::optional<double> hashed_contact_kb;
};

struct EncoderMesh
{
    const char* name;
    When when;
    std::function<NamedMesh()> make;
    EncoderGoals goals{};
    Feature feature{Feature::none};
    bool is_compared{true}; ///< Compares the simplifiers of the peers.
};

/// Context of a part of the suite.
struct EncoderContext : CaseContext
{
    const EncoderMesh& mesh;
};

/// Our simplifier and the peers' on one mesh: faces reached, errors of the surface and its
/// features, and time. All on one thread; ours also on two, with the same result.
void compare_simplifiers(const EncoderContext& context);

} // namespace tactus::bench
