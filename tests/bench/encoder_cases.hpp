// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/bench/cases.hpp"

#include <cstdint>
#include <functional>
#include <optional>

namespace tactus::bench
{

/// Lines of a mesh that a simplifier should keep.
enum class Feature : std::uint8_t
{
    none,
    borders,
    sharp_edges,
};

/// What the encoder has to reach on one mesh; without a value no goal.
struct EncoderGoals
{
    std::optional<double> rms_to_garland_heckbert; ///< Ours by theirs.
    std::optional<double> max_to_garland_heckbert;
    std::optional<double> rms_to_meshoptimizer;
    std::optional<double> us_per_face; ///< On one core.
    std::optional<double> us_per_face_on_two;
    std::optional<double> seconds; ///< On one core.
    std::optional<double> peak_bytes_per_face;
    std::optional<double> file_bytes_per_face;      ///< At 16 bits, hashes not counted.
    std::optional<double> fine_file_bytes_per_face; ///< At 20 bits.
    std::optional<double> read_ns_per_record;       ///< Parsed and linked on one core.
    std::optional<double> base_faces;
    std::optional<double> bound_at_sixth; ///< Largest bound by largest true error, at n/6 faces.
    std::optional<double> bound_at_two_thirds;
    std::optional<double> exact_splits;
    std::optional<double> contact_kb; ///< Until the first exact contact, hashes not counted.
    std::optional<double> hashed_contact_kb;
};

struct EncoderMesh
{
    const char* name;
    When when;
    std::function<NamedMesh()> make;
    EncoderGoals goals{};
    Feature feature{Feature::none};
    bool is_compared{true}; ///< Simplified beside the peers.
};

/// What a part of the suite gets.
struct EncoderContext : CaseContext
{
    const EncoderMesh& mesh;
};

/// The parts of the suite, which fail as cases do.

/// Our simplifier and the peers' on one mesh: faces reached, error of the surface and of its
/// features, time. On one thread; ours on two as well, with the same result.
void compare_simplifiers(const EncoderContext& context);

/// The whole encoder, from a mesh in memory to a file, each run in a process of its own: time,
/// memory, and what the file holds and how fast it is read. The same bytes from one thread and two.
void measure_files(const EncoderContext& context);

/// How much larger bounds are than what they bound, how many splits a distance takes until it is
/// exact, and how many bytes a first contact. With a tool's radius of 1 % of the diagonal.
void measure_bounds(const EncoderContext& context);

} // namespace tactus::bench
