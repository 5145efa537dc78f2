// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"
#include "platform/base/refusal.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/spm/header.hpp"

#include <nlohmann/json_fwd.hpp>

#include <algorithm>
#include <cstdint>
#include <filesystem>
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
    unsigned position_bits{kMinPositionBits};
    bool keeps_winding{false};
    std::uint32_t base_faces{500};
    unsigned threads{std::max(1U, std::thread::hardware_concurrency())};
};

/// What was made, for the summary.
struct Outcome
{
    HeaderFields fields;
    double diagonal_m{0.0};
    double metres_per_unit{0.0};    ///< Of the source.
    double sampled_distance_m{0.0}; ///< Of the source on its grid to the base mesh.
    double seconds{0.0};            ///< From the mesh in memory to the file; without the samples.
    std::uint64_t peak_bytes{0};    ///< Of the whole program so far.
};

/// Writes the model of a mesh; it appears whole or not at all. `source` names the mesh in refusals.
/// `notes` gets a line for each repair.
[[nodiscard]] Result<Outcome, Refusal>
build_model(const TriangleMesh& mesh, const std::string& source, const std::filesystem::path& path,
            const ModelOptions& options, std::vector<std::string>& notes);

/// The figures of --json.
[[nodiscard]] nlohmann::json figures_of(const Outcome& outcome);

} // namespace tactus::spm_build
