// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/spm/header.hpp"
#include "transport/base/refusal.hpp"

#include <nlohmann/json_fwd.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace tactus::spm_build
{

/// How a mesh becomes a model.
struct ModelOptions
{
    double metres_per_unit{1.0};
    std::optional<double> fit_diagonal_m;
    std::optional<double> region_size_m;
    /// Without a number kMinPositionBits, and more where the mesh needs them.
    std::optional<unsigned> position_bits;
    bool keeps_winding{false};
    bool is_centered{false};
    std::optional<std::uint32_t> memory_mib; ///< None: what the machine has.
    std::uint32_t base_faces{500};
    unsigned threads{std::max(1U, std::thread::hardware_concurrency())};
    /// Called now and then, on the calling thread, with how much of a model's work is done: 0 to 1.
    std::function<void(double share)> progress{};
};

/// Where a model's grid lies, and how fine it is at least.
struct GridChoice
{
    std::array<double, 3> place_m{}; ///< In the mesh's frame, scaled, not centred.
    std::optional<double> quantum_max_m;
    /// Vertices of other models, in the mesh's frame, that may lie on its borders.
    std::vector<std::array<double, 3>> beside_m{};
    double moved_m{0.0}; ///< How far a vertex is from its place in the file, at most.
};

/// What was made, for the summary.
struct Outcome
{
    HeaderFields fields;
    double diagonal_m{0.0};
    double metres_per_unit{0.0};          ///< Of the source.
    std::array<double, 3> low_corner_m{}; ///< Of its box, in the model's frame.
    double sampled_distance_m{0.0};       ///< From the source on its grid to the base mesh.
    double seconds{0.0};         ///< From the mesh in memory to the file; without the samples.
    std::uint64_t peak_bytes{0}; ///< The whole program's, so far.
};

/// The step of the grid that the mesh's model gets by itself. Refuses what build_model() does at
/// its start.
[[nodiscard]] Result<double, Refusal> grid_step_of(const TriangleMesh& mesh,
                                                   const std::string& source,
                                                   const ModelOptions& options,
                                                   const GridChoice& grid);

/// Writes the model of a mesh; it appears whole or not at all. `source` names the mesh in refusals.
/// `notes` gets a line for each repair. A mesh that needs more memory than there is, or than is
/// allowed, is refused before the work.
[[nodiscard]] Result<Outcome, Refusal>
build_model(const TriangleMesh& mesh, const std::string& source, const std::filesystem::path& path,
            const ModelOptions& options, const GridChoice& grid, std::vector<std::string>& notes);

/// The figures of --json.
[[nodiscard]] nlohmann::json figures_of(const Outcome& outcome);

} // namespace tactus::spm_build
