// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/cli/command_line.hpp"
#include "host_tools/cli/progress.hpp"
#include "host_tools/cli/run_program.hpp"
#include "host_tools/encode/write_spm.hpp"
#include "host_tools/mesh/prepare.hpp"
#include "host_tools/mesh/read_mesh.hpp"
#include "host_tools/shapes/shapes.hpp"
#include "host_tools/simplify/sampled_distance.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "platform/base/atomic_file.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <sys/resource.h>
#include <thread>
#include <vector>

namespace tactus
{

namespace
{

struct Options
{
    std::string input;
    std::string output;
    std::string shape;
    std::uint32_t shape_faces{0};
    std::string unit{"m"};
    std::optional<double> fit_diagonal_m;
    std::optional<double> region_size_m;
    unsigned position_bits{kMinPositionBits};
    std::uint32_t base_faces{500};
    unsigned threads{std::max(1U, std::thread::hardware_concurrency())};
    bool json{false};

    /// What the model is made of, as messages name it.
    [[nodiscard]] std::string source() const { return shape.empty() ? input : "--shape " + shape; }
};

/// Enough that their largest distance varies by a few percent from seed to seed; 0.1 s.
constexpr std::uint32_t kDistanceSamples = 20'000;
constexpr std::uint64_t kSampleSeed = 1;

/// A failure on the way: one line for the user.
struct Failure
{
    std::string text;
};

/// What was made, for the summary.
struct Outcome
{
    HeaderFields fields;
    double diagonal_m{0.0};
    double sampled_distance_m{0.0}; ///< Of the source on its grid to the base mesh.
    double seconds{0.0};            ///< From reading to the file; without the samples.
    std::uint64_t peak_bytes{0};
};

void declare_options(CommandLine& line, Options& options)
{
    line.add_version(std::string("spm_build ") + TACTUS_VERSION);
    const auto input =
        line.add_option("IN", options.input, "Mesh to read: .ply, .obj, .stl or .off");
    line.add_option("-o,--output", options.output, "Model to write (.spm)").required();
    const std::vector<std::string_view> names = shape_names();
    const auto shape =
        line.add_option("--shape", options.shape, "Make a shape instead of reading a mesh")
            .one_of({names.begin(), names.end()})
            .excludes(input);
    const auto faces = line.add_option("--faces", options.shape_faces, "Faces of the shape")
                           .number_between(kMinShapeFaces, kMaxShapeFaces)
                           .needs(shape);
    shape.needs(faces);
    line.add_option("--unit", options.unit, "Unit of the mesh's coordinates")
        .one_of({"mm", "cm", "m", "in"})
        .show_default();
    line.add_option("--fit-diag", options.fit_diagonal_m,
                    "Scale the model to this bounding-box diagonal, in metres")
        .number_between(kMinFitDiagonal_m, kMaxFitDiagonal_m);
    line.add_option("--position-bits", options.position_bits, "Bits of a coordinate")
        .number_between(kMinPositionBits, kMaxPositionBits)
        .show_default();
    line.add_option("--base-faces", options.base_faces, "Faces of the coarsest mesh, at most")
        .number_between(1, kMaxBaseFaces)
        .show_default();
    line.add_option("--region-size", options.region_size_m,
                    "Edge of a region in metres, rounded down to a power of two quanta")
        .number_between(1e-12, 1e6);
    line.add_option("--threads", options.threads, "Threads to work with")
        .number_between(1, 1024)
        .show_default();
    line.add_flag("--json", options.json, "Print the figures as one JSON object");
}

Result<TriangleMesh, Failure> load_source(const Options& options, std::vector<std::string>& notes)
{
    if (options.shape.empty())
    {
        auto file = read_mesh_file(options.input);
        if (!file)
        {
            return Failure{file.error().text};
        }
        notes = file.value().notes;
        return std::move(file.value().mesh);
    }
    auto mesh = make_shape(*parse_shape(options.shape), options.shape_faces);
    if (!mesh)
    {
        return Failure{mesh.error().text};
    }
    if (mesh.value().faces.size() != options.shape_faces)
    {
        notes.push_back(fmt::format("{} faces were asked for; the shape has {}",
                                    options.shape_faces, mesh.value().faces.size()));
    }
    return std::move(mesh).value();
}

Result<PreparedMesh, Failure> prepare_source(const Options& options,
                                             std::vector<std::string>& notes)
{
    const auto source = load_source(options, notes);
    if (!source)
    {
        return source.error();
    }
    auto prepared = prepare_mesh(source.value(), {*metres_per_unit(options.unit),
                                                  options.fit_diagonal_m, options.position_bits});
    if (!prepared)
    {
        return Failure{options.source() + ": " + prepared.error().text};
    }
    notes.insert(notes.end(), prepared.value().notes.begin(), prepared.value().notes.end());
    return std::move(prepared).value();
}

Result<Simplification, Failure> simplify_source(const Options& options, const QuantisedMesh& mesh)
{
    Progress progress("simplify", "faces");
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
        return Failure{options.source() + ": " + simplification.error().text};
    }
    return std::move(simplification).value();
}

std::uint64_t peak_memory_bytes()
{
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

Result<Outcome, Failure> build(const Options& options, std::vector<std::string>& notes)
{
    const auto start = std::chrono::steady_clock::now();
    // Refuses a place that can't be written before minutes of work; the file itself comes last.
    if (const auto refused = AtomicFile::probe(options.output))
    {
        return Failure{refused->text};
    }
    const auto prepared = prepare_source(options, notes);
    if (!prepared)
    {
        return prepared.error();
    }
    const auto simplification = simplify_source(options, prepared.value().mesh);
    if (!simplification)
    {
        return simplification.error();
    }
    const auto written = write_spm(
        options.output, prepared.value(), simplification.value(),
        {options.position_bits, options.base_faces, options.region_size_m, options.threads});
    if (!written)
    {
        return Failure{written.error().text};
    }
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    const double sampled_quanta = sampled_distance_to_base(
        prepared.value().mesh, simplification.value(), kDistanceSamples, kSampleSeed);
    return Outcome{written.value(), prepared.value().diagonal_m,
                   sampled_quanta * prepared.value().quantum_m, spent.count(), peak_memory_bytes()};
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
        {"bytes_per_face", static_cast<double>(fields.file_bytes) / faces},
        {"quantisation_diag", fields.quantisation_m / outcome.diagonal_m},
        {"e_max_diag", fields.max_error_quanta * quantum_m / outcome.diagonal_m},
        {"hausdorff_diag_sampled", outcome.sampled_distance_m / outcome.diagonal_m},
        {"regions", fields.occupied_regions},
        {"chunks", counts.chunks()},
    };
}

void print_summary(const Options& options, const Outcome& outcome)
{
    const nlohmann::json figures = figures_of(outcome);
    if (options.json)
    {
        fmt::print("{}\n", figures.dump());
        return;
    }
    const HeaderFields& fields = outcome.fields;
    fmt::print("{}: {} faces, {} vertices; {} records in {} rounds on a base of {} faces\n",
               options.output, fields.source_faces, fields.source_vertices, fields.records,
               fields.rounds, fields.base_faces);
    fmt::print("{} bytes, {:.2f} per face, in {} chunks; {} occupied regions\n", fields.file_bytes,
               figures["bytes_per_face"].get<double>(), figures["chunks"].get<std::uint32_t>(),
               fields.occupied_regions);
    fmt::print(
        "diagonal {:.6g} m; of it: quantisation {:.2e}, source to base mesh {:.2e} (sampled), "
        "largest error bound {:.2e}\n",
        outcome.diagonal_m, figures["quantisation_diag"].get<double>(),
        figures["hausdorff_diag_sampled"].get<double>(), figures["e_max_diag"].get<double>());
    fmt::print("{:.1f} s, {:.0f} faces per second, {} MiB at the peak\n", outcome.seconds,
               figures["faces_per_second"].get<double>(), outcome.peak_bytes >> 20U);
}

int run(int argc, char** argv)
{
    CommandLine line("spm_build", "Turns a triangle mesh into an SPM model.");
    Options options;
    declare_options(line, options);
    if (const auto code = line.parse(argc, argv))
    {
        return *code;
    }
    if (options.input.empty() && options.shape.empty())
    {
        return line.fail("give a mesh to read, or --shape and --faces; see --help", kExitUsage);
    }
    AtomicFile::remove_pending_on_signal();
    std::vector<std::string> notes;
    const auto outcome = build(options, notes);
    if (!outcome)
    {
        return line.fail(outcome.error().text);
    }
    for (const std::string& note : notes)
    {
        fmt::print(stderr, "note: {}\n", note);
    }
    print_summary(options, outcome.value());
    return kExitDone;
}

} // namespace

} // namespace tactus

int main(int argc, char** argv)
{
    return tactus::run_program("spm_build", "about 500 bytes a face are needed",
                               [&] { return tactus::run(argc, argv); });
}
