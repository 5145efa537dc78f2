// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/decoded_model.hpp"
#include "host_tools/encode/false_claims.hpp"
#include "host_tools/spm_inspect/options.hpp"
#include "platform/program/command_line.hpp"
#include "platform/program/progress.hpp"
#include "platform/program/run_program.hpp"
#include "transport/base/number_form.hpp"
#include "transport/content_hash.hpp"
#include "transport/store/model_store.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

namespace tactus::spm_inspect
{

namespace
{

/// The least and largest corner of the model in the source's frame.
struct Bounds
{
    std::array<double, 3> low_m{};
    std::array<double, 3> high_m{};
};

Bounds bounds_of(const ModelHeader& header)
{
    const HeaderFields& fields = header.fields();
    Bounds bounds{fields.origin_m, fields.origin_m};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        bounds.high_m[axis] += fields.extent_quanta[axis] * static_cast<double>(header.quantum_m());
    }
    return bounds;
}

nlohmann::json regions_of(const ModelHeader& header)
{
    const auto& grid = header.fields().region_grid;
    nlohmann::json occupied = nlohmann::json::array();
    for (std::uint32_t region = 0; region < header.region_count(); ++region)
    {
        if (header.is_occupied({region}))
        {
            occupied.push_back(
                {{"id", region},
                 {"cell",
                  {region % grid[0], region / grid[0] % grid[1], region / grid[0] / grid[1]}}});
        }
    }
    return occupied;
}

nlohmann::json records_of(const DecodedModel& model)
{
    const ModelCounts counts = model.header().counts();
    const std::array<double, 3>& origin_m = model.header().fields().origin_m;
    nlohmann::json records = nlohmann::json::array();
    for (std::uint32_t i = 0; i < counts.records; ++i)
    {
        const VsplitRecord& record = model.record({i});
        std::array<double, 3> position_m = origin_m;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            position_m[axis] += static_cast<double>(record.position_m[axis]);
        }
        records.push_back({{"vertex", counts.vertex_of({i}).value},
                           {"parent", record.parent.value},
                           {"depth", record.depth},
                           {"position_m", position_m}});
    }
    return records;
}

nlohmann::json describe(const ModelStore& store, const DecodedModel& model, const Options& options)
{
    const ModelHeader& header = store.header();
    const HeaderFields& fields = header.fields();
    const double quantum_m = static_cast<double>(header.quantum_m());
    const Bounds bounds = bounds_of(header);
    nlohmann::json all{
        {"file", store.path().string()},
        {"hash", hash_text(store.hash())},
        {"format_version", fields.format_version},
        {"coder_version", fields.coder_version},
        {"revision", fields.revision},
        {"faces", fields.source_faces},
        {"vertices", fields.source_vertices},
        {"is_closed", header.is_closed()},
        {"base_faces", fields.base_faces},
        {"base_vertices", fields.base_vertices},
        {"records", fields.records},
        {"rounds", fields.rounds},
        {"depth", fields.max_depth},
        {"bounds_m", {{"low", bounds.low_m}, {"high", bounds.high_m}}},
        {"diagonal_m", header.diagonal_m()},
        {"quantum_m", quantum_m},
        {"position_bits", fields.position_bits},
        {"quantisation_m", fields.quantisation_m},
        {"error_max_m", fields.max_error_quanta * quantum_m},
        {"regions",
         {{"grid", fields.region_grid},
          {"cell_m", fields.region_cell_quanta * quantum_m},
          {"occupied", fields.occupied_regions}}},
        {"bytes",
         {{"file", fields.file_bytes},
          {"header", fields.header_bytes},
          {"base", fields.base_bytes},
          {"chunks", model.chunk_bytes()},
          {"index",
           fields.file_bytes - fields.header_bytes - fields.base_bytes - model.chunk_bytes()}}},
        {"bytes_per_face", static_cast<double>(fields.file_bytes) / fields.source_faces},
        {"chunks", header.counts().chunks()},
    };
    if (options.regions)
    {
        all["regions"]["list"] = regions_of(header);
    }
    if (options.records)
    {
        all["record_list"] = records_of(model);
    }
    return all;
}

void print_text(const nlohmann::json& all)
{
    const auto number = [&](const char* pointer)
    { return all.at(nlohmann::json::json_pointer(pointer)).get<double>(); };
    const auto count = [&](const char* pointer)
    { return all.at(nlohmann::json::json_pointer(pointer)).get<std::uint64_t>(); };
    fmt::print("{}: SPM format {}, coder {}, revision {}\n", all["file"].get<std::string>(),
               count("/format_version"), count("/coder_version"), count("/revision"));
    fmt::print("hash          {}\n", all["hash"].get<std::string>());
    fmt::print("mesh          {} faces, {} vertices, {}\n", count("/faces"), count("/vertices"),
               all["is_closed"].get<bool>() ? "closed" : "open (distances are unsigned)");
    fmt::print("base          {} faces, {} vertices\n", count("/base_faces"),
               count("/base_vertices"));
    fmt::print("records       {} from {} rounds, depth {}\n", count("/records"), count("/rounds"),
               count("/depth"));
    for (const char* axis : {"0", "1", "2"})
    {
        fmt::print("bounds {}      {:.6g} .. {:.6g} m\n", "xyz"[*axis - '0'],
                   number((std::string("/bounds_m/low/") + axis).c_str()),
                   number((std::string("/bounds_m/high/") + axis).c_str()));
    }
    const double diagonal_m = number("/diagonal_m");
    fmt::print("diagonal      {:.6g} m\n", diagonal_m);
    fmt::print("quantum       {:.6g} m, {} bits\n", number("/quantum_m"), count("/position_bits"));
    fmt::print("quantisation  {:.3g} m, {:.2e} of the diagonal\n", number("/quantisation_m"),
               number("/quantisation_m") / diagonal_m);
    fmt::print("error bound   {:.3g} m at most, {:.2e} of the diagonal\n", number("/error_max_m"),
               number("/error_max_m") / diagonal_m);
    fmt::print("regions       {} x {} x {} of {:.6g} m, {} occupied\n", count("/regions/grid/0"),
               count("/regions/grid/1"), count("/regions/grid/2"), number("/regions/cell_m"),
               count("/regions/occupied"));
    fmt::print("bytes         {}, {:.2f} per face: header {}, base {}, index {}, chunks {}\n",
               count("/bytes/file"), number("/bytes_per_face"), count("/bytes/header"),
               count("/bytes/base"), count("/bytes/index"), count("/bytes/chunks"));
    fmt::print("all {} chunks sound, all {} records linked\n", count("/chunks"), count("/records"));
    if (all["regions"].contains("list"))
    {
        for (const nlohmann::json& region : all["regions"]["list"])
        {
            fmt::print("region {}: cell {} {} {}\n", region["id"].get<std::uint32_t>(),
                       region["cell"][0].get<std::uint32_t>(),
                       region["cell"][1].get<std::uint32_t>(),
                       region["cell"][2].get<std::uint32_t>());
        }
    }
    for (const nlohmann::json& record : all.value("record_list", nlohmann::json::array()))
    {
        fmt::print("vertex {}: from {}, depth {}, at {:.9g} {:.9g} {:.9g}\n",
                   record["vertex"].get<std::uint32_t>(), record["parent"].get<std::uint32_t>(),
                   record["depth"].get<std::uint32_t>(), record["position_m"][0].get<double>(),
                   record["position_m"][1].get<double>(), record["position_m"][2].get<double>());
    }
}

ClaimsFound check_claims(const ModelStore& store, const DecodedModel& model)
{
    Progress progress("spm_inspect", "check", "records");
    ClaimCheck check;
    check.progress = [&](std::size_t done)
    {
        const std::size_t records = model.header().counts().records;
        progress.update(done, records + records / 2);
    };
    return find_false_claims(store, model, check);
}

int report_damage(const CommandLine& line, const std::vector<std::string>& damage)
{
    constexpr std::size_t kShown = 20;
    for (std::size_t i = 0; i < std::min(damage.size(), kShown); ++i)
    {
        line.fail(damage[i]);
    }
    if (damage.size() > kShown)
    {
        line.fail("and " + counted(damage.size() - kShown, "more damaged piece"));
    }
    return kExitFailed;
}

int run(int argc, char** argv)
{
    CommandLine line("spm_inspect", "Shows and checks an SPM model.");
    const auto parsed = parse_options(line, argc, argv);
    if (const int* code = std::get_if<int>(&parsed))
    {
        return *code;
    }
    const auto& options = std::get<Options>(parsed);
    if (!options.points.empty())
    {
        const auto fault = print_distances(options.file, options.points, options.json);
        return fault ? line.fail(*fault) : kExitDone;
    }
    const auto store = ModelStore::open(options.file);
    if (!store)
    {
        return line.fail(store.error().text);
    }
    std::vector<std::string> damage;
    DecodedModel model = DecodedModel::decode(store.value(), damage);
    if (!damage.empty())
    {
        return report_damage(line, damage);
    }
    const ClaimsFound claims = check_claims(store.value(), model);
    if (!claims.contradiction.empty())
    {
        return line.fail(
            fmt::format("{}: contradicts itself: {}", options.file, claims.contradiction));
    }
    for (const std::string& claim : claims.false_claims)
    {
        line.fail(fmt::format("{}: false claim: {}", options.file, claim));
    }
    if (!claims.false_claims.empty())
    {
        return kExitCriterionNotMet;
    }
    if (options.extractor.is_wanted())
    {
        if (const auto fault = options.extractor.run(model))
        {
            return line.fail(*fault);
        }
    }
    const nlohmann::json all = describe(store.value(), model, options);
    if (options.json)
    {
        fmt::print("{}\n", all.dump(2));
    }
    else
    {
        print_text(all);
    }
    return kExitDone;
}

} // namespace

} // namespace tactus::spm_inspect

int main(int argc, char** argv)
{
    return tactus::run_program("spm_inspect", "about 150 bytes per face are needed",
                               [&] { return tactus::spm_inspect::run(argc, argv); });
}
