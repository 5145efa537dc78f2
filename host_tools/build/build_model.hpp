// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/mesh/triangle_mesh.hpp"
#include "rt_core/base/result.hpp"
#include "rt_core/spm/header.hpp"
#include "transport/base/refusal.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace tactus
{

/// Options of the conversion of a mesh to a model.
struct ModelOptions
{
    double metres_per_unit{1.0};
    std::optional<double> fit_diagonal_m;
    std::optional<double> region_size_m;
    /// Bits of a coordinate. [default: kMinPositionBits, or more if the mesh needs them]
    std::optional<unsigned> position_bits;
    std::uint32_t revision{0}; ///< HeaderFields::revision.
    bool keeps_winding{false};
    bool is_centered{false};
    /// Memory limit in MiB. [default: the machine's available memory]
    std::optional<std::uint32_t> memory_mib;
    std::uint32_t base_faces{500};
    unsigned threads{std::max(1U, std::thread::hardware_concurrency())};
    /// Callback from time to time, on the calling thread, with the share of a model's work that is
    /// done: 0 to 1.
    std::function<void(double share)> progress{};
};

/// Place of a model's grid, and its maximum step.
struct GridChoice
{
    /// A point of the grid in the mesh's frame, scaled, not centred.
    std::array<double, 3> place_m{};
    std::optional<double> quantum_max_m;
    /// Vertices of other models, in the mesh's frame, that may lie on its borders.
    std::vector<std::array<double, 3>> beside_m{};
    double moved_m{0.0}; ///< Greatest distance of a vertex from its place in the file.
};

/// Figures of a built model, for the summary.
struct BuiltModel
{
    HeaderFields fields;
    double diagonal_m{0.0};
    double metres_per_unit{0.0}; ///< Metres per unit of the source.
    /// Least corner of the source's box, in the model's frame.
    std::array<double, 3> low_corner_m{};
    /// Sampled distance from the source on its grid to the base mesh.
    double sampled_distance_m{0.0};
    double seconds{0.0};         ///< Time from the mesh in memory to the file, without the samples.
    std::uint64_t peak_bytes{0}; ///< Peak memory of the whole program so far.
};

/// Step, in metres, of the grid that build_model() would choose. Refuses a mesh for the same
/// reasons up to that choice.
[[nodiscard]] Result<double, Refusal> grid_step_of(const TriangleMesh& mesh,
                                                   const std::string& source,
                                                   const ModelOptions& options,
                                                   const GridChoice& grid);

/// Writes the model of a mesh; the file appears as a whole or not at all. `source` names the mesh
/// in refusals. `notes` gets a line for each repair. A mesh that needs more memory than available
/// or allowed is refused before the work.
[[nodiscard]] Result<BuiltModel, Refusal>
build_model(const TriangleMesh& mesh, const std::string& source, const std::filesystem::path& path,
            const ModelOptions& options, const GridChoice& grid, std::vector<std::string>& notes);

/// Peak memory, rounded up, from a mesh with this number of faces until its model is written.
[[nodiscard]] std::uint64_t needed_mib(std::size_t faces);

/// Memory that this program can use without swapping, limited by the machine and its control group;
/// none if unknown. `root` replaces / in tests.
[[nodiscard]] std::optional<std::uint64_t> available_mib(const std::filesystem::path& root = "/");

/// Refuses a need above `allowed_mib`, or above the machine's available memory if that is not set,
/// and states the least sufficient value. `what` names the mesh or file in the refusal.
[[nodiscard]] std::optional<Refusal> check_memory(const std::string& what, std::uint64_t needed,
                                                  std::optional<std::uint32_t> allowed_mib);

} // namespace tactus
