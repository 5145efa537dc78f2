// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/build/build_model.hpp"
#include "host_tools/mesh/prepare.hpp"
#include "host_tools/mesh/read_mesh.hpp"
#include "host_tools/shapes/shapes.hpp"
#include "host_tools/spm_build/build_scene.hpp"
#include "host_tools/spm_build/options.hpp"
#include "host_tools/spm_build/placing.hpp"
#include "platform/program/command_line.hpp"
#include "platform/program/progress.hpp"
#include "platform/program/run_program.hpp"
#include "transport/base/atomic_file.hpp"
#include "transport/base/number_form.hpp"
#include "transport/base/program_log.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <string>
#include <variant>
#include <vector>

namespace tactus::spm_build
{

namespace
{

/// Figures for --json.
nlohmann::json figures_of(const BuiltModel& model)
{
    const HeaderFields& fields = model.fields;
    const double quantum_m = std::ldexp(1.0, fields.quantum_log2);
    const ModelCounts counts{fields.base_vertices, fields.base_faces, fields.records};
    const double faces = fields.source_faces;
    return {
        {"faces", fields.source_faces},
        {"vertices", fields.source_vertices},
        {"records", fields.records},
        {"rounds", fields.rounds},
        {"base_faces", fields.base_faces},
        {"seconds", model.seconds},
        {"faces_per_second", faces / model.seconds},
        {"peak_bytes", model.peak_bytes},
        {"file_bytes", fields.file_bytes},
        {"metres_per_unit", model.metres_per_unit},
        {"bytes_per_face", static_cast<double>(fields.file_bytes) / faces},
        {"quantisation_diag", fields.quantisation_m / model.diagonal_m},
        {"e_max_diag", fields.max_error_quanta * quantum_m / model.diagonal_m},
        {"hausdorff_diag_sampled", model.sampled_distance_m / model.diagonal_m},
        {"regions", fields.occupied_regions},
        {"chunks", counts.chunks()},
    };
}

Result<TriangleMesh, Refusal> load_source(const Options& options, std::vector<std::string>& notes)
{
    if (options.shape.empty())
    {
        // The size of a pipe is unknown; its content is checked after reading.
        std::error_code unknown;
        const std::uintmax_t bytes = std::filesystem::file_size(options.input, unknown);
        if (auto refused = unknown ? std::nullopt
                                   : check_memory(options.input + ": a file of " +
                                                      std::to_string(bytes) + " bytes",
                                                  bytes >> 20U, options.model.memory_mib))
        {
            return *refused;
        }
        auto file = read_mesh_file(options.input, options.format);
        if (!file)
        {
            std::error_code code;
            const bool is_pipe = !options.format && std::filesystem::exists(options.input, code) &&
                                 !std::filesystem::is_regular_file(options.input, code) &&
                                 !std::filesystem::is_directory(options.input, code);
            return Refusal{file.error().text + (is_pipe ? "; a pipe needs --format" : "")};
        }
        notes = file.value().notes;
        return std::move(file.value().mesh);
    }
    auto mesh = make_shape(*parse_shape(options.shape), options.shape_faces);
    if (!mesh)
    {
        return Refusal{mesh.error().text};
    }
    if (mesh.value().faces.size() != options.shape_faces)
    {
        notes.push_back(fmt::format("{} faces were requested; the shape has {}",
                                    options.shape_faces, mesh.value().faces.size()));
    }
    return std::move(mesh).value();
}

Result<BuiltModel, Refusal> build(const Options& options, std::vector<std::string>& notes)
{
    // A place that cannot be written is refused before minutes of work; the file itself is written
    // last.
    if (const auto refused = AtomicFile::probe(options.output))
    {
        return *refused;
    }
    const auto start = std::chrono::steady_clock::now();
    auto mesh = load_source(options, notes);
    if (!mesh)
    {
        return mesh.error();
    }
    if (options.placing.is_y_up)
    {
        turn_y_up(mesh.value());
    }
    const std::chrono::duration<double> loading = std::chrono::steady_clock::now() - start;
    Progress progress("spm_build", "build", "faces");
    ModelOptions model = options.model;
    model.progress = [&](double share)
    {
        const std::size_t faces = mesh.value().faces.size();
        progress.update(static_cast<std::size_t>(share * static_cast<double>(faces)), faces);
    };
    auto outcome = build_model(mesh.value(), options.source(), options.output, model, {}, notes);
    if (outcome)
    {
        outcome.value().seconds += loading.count();
        const ModelPlace place{outcome.value().diagonal_m, options.model.metres_per_unit,
                               outcome.value().low_corner_m};
        std::ranges::move(size_notes(mesh.value(), place, options.model.fit_diagonal_m.has_value()),
                          std::back_inserter(notes));
    }
    return outcome;
}

void print_summary(const Options& options, const BuiltModel& outcome)
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
        "diagonal {:.6g} m, a unit of the mesh is {:.6g} m; as fractions of the diagonal: "
        "quantisation {:.2e}, source to base mesh {:.2e} (sampled), largest error bound {:.2e}\n",
        outcome.diagonal_m, outcome.metres_per_unit, figures["quantisation_diag"].get<double>(),
        figures["hausdorff_diag_sampled"].get<double>(), figures["e_max_diag"].get<double>());
    fmt::print("{:.1f} s, {:.0f} faces per second, {} MiB at the peak\n", outcome.seconds,
               figures["faces_per_second"].get<double>(), outcome.peak_bytes >> 20U);
}

void print_scene_summary(const Options& options, const SceneOutcome& outcome)
{
    nlohmann::json models = nlohmann::json::array();
    for (const SceneModel& model : outcome.models)
    {
        nlohmann::json figures = figures_of(model.outcome);
        if (!options.json)
        {
            fmt::print("{}.spm: {} faces, {} bytes, {:.2f} per face; {}\n", model.name,
                       model.outcome.fields.source_faces, model.outcome.fields.file_bytes,
                       figures["bytes_per_face"].get<double>(), counted(model.objects, "object"));
        }
        figures["name"] = model.name;
        figures["objects"] = model.objects;
        models.push_back(std::move(figures));
    }
    if (options.json)
    {
        fmt::print("{}\n", nlohmann::json{{"scene", outcome.file.string()},
                                          {"objects", outcome.objects},
                                          {"models", std::move(models)}}
                               .dump());
        return;
    }
    fmt::print("{}: {} of {}\n", outcome.file.string(), counted(outcome.objects, "object"),
               counted(outcome.models.size(), "model"));
}

int make_scene(const CommandLine& line, const Options& options)
{
    const auto outcome = build_scene(options.input, options.output, options.model, options.placing);
    if (!outcome)
    {
        return line.fail(outcome.error().text);
    }
    for (const std::string& note : outcome.value().notes)
    {
        log_message(LogLevel::info, "spm_build", "note: " + note);
    }
    for (const SceneModel& model : outcome.value().models)
    {
        for (const std::string& note : model.notes)
        {
            log_message(LogLevel::info, "spm_build", fmt::format("note: {}: {}", model.name, note));
        }
    }
    print_scene_summary(options, outcome.value());
    return kExitDone;
}

int run(int argc, char** argv)
{
    CommandLine line("spm_build",
                     "Converts a triangle mesh, or each mesh of a glTF scene, to an SPM model.");
    const auto parsed = parse_options(line, argc, argv);
    if (const int* code = std::get_if<int>(&parsed))
    {
        return *code;
    }
    const auto& options = std::get<Options>(parsed);
    AtomicFile::remove_pending_on_signal();
    if (options.is_of_scene())
    {
        return make_scene(line, options);
    }
    std::vector<std::string> notes;
    const auto outcome = build(options, notes);
    if (!outcome)
    {
        return line.fail(outcome.error().text);
    }
    for (const std::string& note : notes)
    {
        log_message(LogLevel::info, "spm_build", "note: " + note);
    }
    print_summary(options, outcome.value());
    return kExitDone;
}

} // namespace

} // namespace tactus::spm_build

int main(int argc, char** argv)
{
    return tactus::run_program("spm_build", "about 480 bytes per face are needed",
                               [&] { return tactus::spm_build::run(argc, argv); });
}
