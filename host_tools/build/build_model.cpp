// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/build/build_model.hpp"

#include "host_tools/encode/write_spm.hpp"
#include "host_tools/mesh/prepare.hpp"
#include "host_tools/simplify/handle_cuts.hpp"
#include "host_tools/simplify/sampled_distance.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "transport/base/number_form.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <limits>
#include <sys/resource.h>
#include <utility>

namespace tactus
{

namespace
{

constexpr std::uint64_t kUnknown = std::numeric_limits<std::uint64_t>::max();
constexpr std::uint64_t kMib = std::uint64_t{1} << 20U;

/// Upper estimate of the memory for a face. Measured on shapes and scans of 13 k to 400 k faces
/// with 2 and 16 threads: 310 to 440 bytes, besides kBaseMib.
constexpr std::uint64_t kBytesPerFace = 480;
constexpr std::uint64_t kBaseMib = 16;

/// The number at the start of a file; kUnknown without one, such as "max" for a group without a
/// limit.
std::uint64_t number_in(const std::filesystem::path& path)
{
    std::ifstream file(path);
    std::uint64_t bytes = 0;
    return file >> bytes ? bytes : kUnknown;
}

std::uint64_t available_of_machine(const std::filesystem::path& root)
{
    std::ifstream file(root / "proc/meminfo");
    for (std::string key; file >> key;)
    {
        std::uint64_t kib = 0;
        if (key == "MemAvailable:" && file >> kib)
        {
            return kib * 1'024;
        }
        file.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
    }
    return kUnknown;
}

/// Remaining memory of the control group (version 2), seen from within.
std::uint64_t left_of_group(const std::filesystem::path& root)
{
    const std::filesystem::path group = root / "sys/fs/cgroup";
    const std::uint64_t most = number_in(group / "memory.max");
    const std::uint64_t used = number_in(group / "memory.current");
    return most == kUnknown || used == kUnknown ? kUnknown : most - std::min(used, most);
}

} // namespace

std::uint64_t needed_mib(std::size_t faces)
{
    return kBaseMib + (std::uint64_t{faces} * kBytesPerFace + kMib - 1) / kMib;
}

std::optional<std::uint64_t> available_mib(const std::filesystem::path& root)
{
    const std::uint64_t bytes = std::min(available_of_machine(root), left_of_group(root));
    return bytes == kUnknown ? std::nullopt : std::optional(bytes / kMib);
}

std::optional<Refusal> check_memory(const std::string& what, std::uint64_t needed,
                                    std::optional<std::uint32_t> allowed_mib)
{
    if (allowed_mib)
    {
        return needed <= *allowed_mib
                   ? std::nullopt
                   : std::optional(Refusal{fmt::format("{} needs {} MiB; --memory-mib allows {}",
                                                       what, needed, *allowed_mib)});
    }
    const auto available = available_mib();
    return !available || needed <= *available
               ? std::nullopt
               : std::optional(Refusal{fmt::format("{} needs {} MiB, but {} are available; set "
                                                   "--memory-mib {} to build with swapping",
                                                   what, needed, *available, needed)});
}

namespace
{

/// Number of samples: their largest distance varies by a few percent between seeds, and they take
/// 0.1 s.
constexpr std::uint32_t kDistanceSamples = 20'000;
constexpr std::uint64_t kSampleSeed = 1;
/// Maximum number of passes that cut handles open. Each pass cuts the handles whose rings do not
/// touch.
constexpr int kCutPassesMax = 16;

/// Measured shares of the work that is done when the mesh is on its grid, and when it is
/// simplified.
constexpr double kPrepared = 0.06;
constexpr double kSimplified = 0.85;

void tell(const ModelOptions& options, double from, double to, double share)
{
    if (options.progress)
    {
        options.progress(from + (to - from) * share);
    }
}

/// Options of prepare_mesh(). A model that is scaled to a size has no neighbours with which to
/// share a grid.
PrepareOptions preparation(const ModelOptions& options, const GridChoice& grid)
{
    PrepareOptions preparing;
    preparing.metres_per_unit = options.metres_per_unit;
    preparing.fit_diagonal_m = options.fit_diagonal_m;
    preparing.position_bits = options.position_bits.value_or(kMinPositionBits);
    preparing.adds_bits = !options.position_bits;
    preparing.keeps_winding = options.keeps_winding;
    preparing.is_centered = options.is_centered;
    preparing.stitches = true;
    preparing.beside_m = grid.beside_m;
    preparing.moved_m = grid.moved_m;
    if (!options.fit_diagonal_m)
    {
        preparing.grid_place_m = grid.place_m;
        preparing.quantum_max_m = options.position_bits ? std::nullopt : grid.quantum_max_m;
    }
    return preparing;
}

std::optional<Refusal> check_mesh_memory(const TriangleMesh& mesh, const std::string& source,
                                         const ModelOptions& options)
{
    return check_memory(fmt::format("{}: a mesh of {} faces", source, mesh.faces.size()),
                        needed_mib(mesh.faces.size()), options.memory_mib);
}

/// Simplifies with reports of progress; `from` is the share of the work done before.
Result<Simplification, Refusal> simplify_with_progress(const QuantisedMesh& mesh,
                                                       const ModelOptions& options, double from)
{
    SimplifyOptions simplify_options;
    simplify_options.base_faces = options.base_faces;
    simplify_options.threads = options.threads;
    simplify_options.progress = [&](std::size_t left, std::size_t total)
    {
        tell(options, from, kSimplified,
             static_cast<double>(total - left) / static_cast<double>(total));
        return true;
    };
    auto simplification = simplify(mesh, simplify_options);
    if (!simplification)
    {
        return Refusal{simplification.error().text};
    }
    return std::move(simplification).value();
}

/// Simplifies the mesh. If the base is too large, cuts its handles open and simplifies again. A
/// closed mesh still counts as closed, since the borders of a cut coincide.
Result<Simplification, Refusal> simplify_all(QuantisedMesh& mesh, const ModelOptions& options,
                                             std::vector<std::string>& notes)
{
    auto simplification = simplify_with_progress(mesh, options, kPrepared);
    const bool is_closed = simplification && simplification.value().is_closed;
    const std::size_t faces_max = std::max(kGrownBaseFaces, options.base_faces);
    std::size_t handles = 0;
    std::size_t copies = 0;
    for (int pass = 0; pass < kCutPassesMax && simplification &&
                       simplification.value().base_faces.size() > faces_max;
         ++pass)
    {
        const std::vector<std::vector<MeshEdge>> rings =
            find_handle_rings(mesh, simplification.value());
        if (rings.empty())
        {
            break;
        }
        std::vector<MeshEdge> edges;
        for (const std::vector<MeshEdge>& ring : rings)
        {
            edges.insert(edges.end(), ring.begin(), ring.end());
        }
        handles += rings.size();
        copies += cut_open(mesh, edges);
        simplification = simplify_with_progress(mesh, options, kSimplified);
    }
    if (simplification && handles > 0)
    {
        simplification.value().is_closed = is_closed;
        notes.push_back(fmt::format("{} cut open without a gap, with {} vertices duplicated: the "
                                    "base mesh would have more than {} faces otherwise",
                                    counted(handles, "handle"), copies, faces_max));
    }
    return simplification;
}

/// Adds a note about a base mesh above the requested size, since the whole base is kept in memory.
void note_base(std::size_t faces, std::uint32_t wanted, std::vector<std::string>& notes)
{
    if (faces > wanted)
    {
        notes.push_back(fmt::format(
            "the base mesh has {} faces instead of {}: pieces, holes or handles prevent fewer",
            faces, wanted));
    }
}

/// Adds a note if the requested bits give a coarser grid than the mesh's shape needs.
void note_few_bits(const TriangleMesh& mesh, ModelOptions options, double quantum_m,
                   std::vector<std::string>& notes)
{
    if (!options.position_bits)
    {
        return;
    }
    const unsigned asked = std::exchange(options.position_bits, std::nullopt).value();
    const auto step_m = grid_step(mesh, preparation(options, {}));
    if (step_m && step_m.value() < quantum_m)
    {
        notes.push_back(
            fmt::format("{} bits a coordinate give steps of {:.3g} m, which change the mesh's "
                        "shape; without --position-bits the steps would be {:.3g} m",
                        asked, quantum_m, step_m.value()));
    }
}

std::uint64_t peak_memory_bytes()
{
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

} // namespace

Result<double, Refusal> grid_step_of(const TriangleMesh& mesh, const std::string& source,
                                     const ModelOptions& options, const GridChoice& grid)
{
    if (auto refused = check_mesh_memory(mesh, source, options))
    {
        return *refused;
    }
    auto step_m = grid_step(mesh, preparation(options, grid));
    return step_m ? step_m : Refusal{source + ": " + step_m.error().text};
}

Result<BuiltModel, Refusal> build_model(const TriangleMesh& mesh, const std::string& source,
                                        const std::filesystem::path& path,
                                        const ModelOptions& options, const GridChoice& grid,
                                        std::vector<std::string>& notes)
{
    const auto start = std::chrono::steady_clock::now();
    if (auto refused = check_mesh_memory(mesh, source, options))
    {
        return *refused;
    }
    auto prepared = prepare_mesh(mesh, preparation(options, grid));
    if (!prepared)
    {
        return Refusal{source + ": " + prepared.error().text};
    }
    notes.insert(notes.end(), prepared.value().notes.begin(), prepared.value().notes.end());
    note_few_bits(mesh, options, prepared.value().quantum_m, notes);
    tell(options, 0.0, kPrepared, 1.0);
    const auto simplification = simplify_all(prepared.value().mesh, options, notes);
    if (!simplification)
    {
        return Refusal{source + ": " + simplification.error().text};
    }
    const auto written = write_spm(
        path, prepared.value(), simplification.value(),
        {prepared.value().position_bits, options.base_faces, options.region_size_m,
         options.revision, options.threads, [&options](std::size_t done, std::size_t total) {
             tell(options, kSimplified, 1.0,
                  static_cast<double>(done) / static_cast<double>(total));
         }});
    if (!written)
    {
        return Refusal{written.error().text};
    }
    note_base(simplification.value().base_faces.size(), options.base_faces, notes);
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    const double sampled_quanta = sampled_distance_to_base(
        prepared.value().mesh, simplification.value(), kDistanceSamples, kSampleSeed);
    return BuiltModel{written.value(),
                      prepared.value().diagonal_m,
                      prepared.value().metres_per_unit,
                      prepared.value().origin_m,
                      sampled_quanta * prepared.value().quantum_m,
                      spent.count(),
                      peak_memory_bytes()};
}

} // namespace tactus
