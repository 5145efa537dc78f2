// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/spm_build/build_model.hpp"

#include "host_tools/cli/progress.hpp"
#include "host_tools/encode/write_spm.hpp"
#include "host_tools/mesh/prepare.hpp"
#include "host_tools/simplify/sampled_distance.hpp"
#include "host_tools/simplify/simplify.hpp"

#include <nlohmann/json.hpp>

#include <chrono>
#include <cmath>
#include <sys/resource.h>

namespace tactus::spm_build
{

namespace
{

/// Enough that their largest distance varies by a few percent from seed to seed; 0.1 s.
constexpr std::uint32_t kDistanceSamples = 20'000;
constexpr std::uint64_t kSampleSeed = 1;

Result<Simplification, Refusal> simplify_with_progress(const QuantisedMesh& mesh,
                                                       const ModelOptions& options)
{
    Progress progress("spm_build", "simplify", "faces");
    SimplifyOptions simplify_options;
    simplify_options.base_faces = options.base_faces;
    simplify_options.threads = options.threads;
    simplify_options.progress = [&](std::size_t left, std::size_t total)
    {
        progress.update(total - left, total);
        return true;
    };
    auto simplification = simplify(mesh, simplify_options);
    if (!simplification)
    {
        return Refusal{simplification.error().text};
    }
    return std::move(simplification).value();
}

std::uint64_t peak_memory_bytes()
{
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

} // namespace

Result<Outcome, Refusal> build_model(const TriangleMesh& mesh, const std::string& source,
                                     const std::filesystem::path& path, const ModelOptions& options,
                                     std::vector<std::string>& notes)
{
    const auto start = std::chrono::steady_clock::now();
    const auto prepared = prepare_mesh(mesh, {options.metres_per_unit, options.fit_diagonal_m,
                                              options.position_bits, options.keeps_winding});
    if (!prepared)
    {
        return Refusal{source + ": " + prepared.error().text};
    }
    notes.insert(notes.end(), prepared.value().notes.begin(), prepared.value().notes.end());
    const auto simplification = simplify_with_progress(prepared.value().mesh, options);
    if (!simplification)
    {
        return Refusal{source + ": " + simplification.error().text};
    }
    const auto written = write_spm(
        path, prepared.value(), simplification.value(),
        {options.position_bits, options.base_faces, options.region_size_m, options.threads});
    if (!written)
    {
        return Refusal{written.error().text};
    }
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    const double sampled_quanta = sampled_distance_to_base(
        prepared.value().mesh, simplification.value(), kDistanceSamples, kSampleSeed);
    return Outcome{written.value(),
                   prepared.value().diagonal_m,
                   prepared.value().metres_per_unit,
                   sampled_quanta * prepared.value().quantum_m,
                   spent.count(),
                   peak_memory_bytes()};
}

nlohmann::json figures_of(const Outcome& outcome)
{
    const HeaderFields& fields = outcome.fields;
    const double quantum_m = std::ldexp(1.0, fields.quantum_log2);
    const ModelCounts counts{fields.base_vertices, fields.base_faces, fields.records};
    const double faces = fields.source_faces;
    return {
        {"faces", fields.source_faces},
        {"vertices", fields.source_vertices},
        {"records", fields.records},
        {"rounds", fields.rounds},
        {"base_faces", fields.base_faces},
        {"seconds", outcome.seconds},
        {"faces_per_second", faces / outcome.seconds},
        {"peak_bytes", outcome.peak_bytes},
        {"file_bytes", fields.file_bytes},
        {"metres_per_unit", outcome.metres_per_unit},
        {"bytes_per_face", static_cast<double>(fields.file_bytes) / faces},
        {"quantisation_diag", fields.quantisation_m / outcome.diagonal_m},
        {"e_max_diag", fields.max_error_quanta * quantum_m / outcome.diagonal_m},
        {"hausdorff_diag_sampled", outcome.sampled_distance_m / outcome.diagonal_m},
        {"regions", fields.occupied_regions},
        {"chunks", counts.chunks()},
    };
}

} // namespace tactus::spm_build
