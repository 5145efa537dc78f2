// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// The whole encoder and its files.

#include "tests/bench/encode_run.hpp"
#include "tests/bench/encoder_cases.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/reading_speed.hpp"
#include "tests/shared/temporary_folder.hpp"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <sstream>

namespace tactus::bench
{

namespace
{

constexpr std::uint32_t kFineBits = 20;

std::string bytes_of(const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    std::ostringstream bytes;
    bytes << file.rdbuf();
    return std::move(bytes).str();
}

/// What a file would lack without its hash tree.
double hash_bytes(const ModelCounts& counts)
{
    const std::size_t hashes =
        counts.chunks() + counts.index_pages() + std::size_t{1}; // The base's.
    return static_cast<double>(hashes * sizeof(ContentHash) + kRootHashBytes);
}

/// The first half of the model's hash, as rows have one.
std::uint64_t short_hash(const ModelStore& store)
{
    std::uint64_t bits = 0;
    std::memcpy(&bits, store.hash().data(), sizeof(bits));
    return bits;
}

void add_cost(CaseRows& rows, const EncodeRun& on_one, const EncodeRun& on_two,
              const HeaderFields& fields, const EncoderGoals& goals)
{
    const double faces = fields.source_faces;
    const auto add = [&](const char* metric, double seconds, std::optional<double> goal)
    { rows.add(metric, 1e6 * seconds / faces, "us a face", goal); };
    rows.add("faces", faces, "");
    rows.add("rounds", fields.rounds, "");
    rows.add("base faces", fields.base_faces, "", goals.base_faces);
    rows.add("time on one core", on_one.total_s(), "s", goals.seconds);
    add("one core", on_one.total_s(), goals.us_per_face);
    add("of it prepare", on_one.prepare_s, std::nullopt);
    add("simplify", on_one.simplify_s, std::nullopt);
    add("write", on_one.write_s, std::nullopt);
    add("processor", on_one.processor_s, std::nullopt);
    add("two threads", on_two.total_s(), goals.us_per_face_on_two);
    const std::uint64_t peak_bytes = std::max(on_one.peak_bytes, on_two.peak_bytes);
    rows.add("peak", static_cast<double>(peak_bytes) / faces, "B a face",
             goals.peak_bytes_per_face);
}

void add_content(CaseRows& rows, const ModelStore& store, const ModelStore& fine,
                 const EncoderGoals& goals)
{
    const HeaderFields& fields = store.header().fields();
    const double hashes = hash_bytes(store.header().counts());
    const auto add = [&](const char* metric, double bytes, std::optional<double> goal)
    { rows.add(metric, bytes / fields.source_faces, "B a face", goal); };
    const auto bytes_of_file = [](const ModelStore& one)
    { return static_cast<double>(one.header().fields().file_bytes); };
    rows.add("records", fields.records, "");
    add("16 bits without hashes", bytes_of_file(store) - hashes, goals.file_bytes_per_face);
    add("20 bits without hashes", bytes_of_file(fine) - hash_bytes(fine.header().counts()),
        goals.fine_file_bytes_per_face);
    add("hashes", hashes, std::nullopt);
}

CaseFailure add_reading(CaseRows& rows, const ModelStore& store, const EncoderContext& context)
{
    const PinnedCore pinned(context.options.core);
    const auto speed = measure_reading(store, context.options.passes_or(7, 3));
    if (!speed)
    {
        return speed.error().text;
    }
    rows.add("parse", speed.value().parse_ns, "ns a record");
    rows.add("link", speed.value().link_ns, "ns a record");
    rows.add("both", speed.value().both_ns, "ns a record", context.mesh.goals.read_ns_per_record);
    rows.add("that is", 1e3 / speed.value().both_ns, "M records/s");
    return std::nullopt;
}

} // namespace

CaseFailure measure_files(const EncoderContext& context)
{
    const test::TemporaryFolder folder("bench-encoder");
    const std::uint32_t passes = context.options.passes_or(3, 1);
    const EncodeJob job{folder.path() / "one.spm", kMinPositionBits, 1, passes};
    const EncodeJob job_on_two{folder.path() / "two.spm", kMinPositionBits, 2, passes};
    const EncodeJob fine_job{folder.path() / "fine.spm", kFineBits, 2, 1};
    const auto on_one = encode_in_child(context, job);
    const auto on_two = encode_in_child(context, job_on_two);
    const auto fine_run = encode_in_child(context, fine_job);
    for (const auto* run : {&on_one, &on_two, &fine_run})
    {
        if (!*run)
        {
            return run->error().text;
        }
    }
    const std::string& scene = on_one.value().scene;
    if (bytes_of(job.path) != bytes_of(job_on_two.path))
    {
        return scene + ": one thread and two give different files";
    }
    const auto store = ModelStore::open(job.path);
    const auto fine = ModelStore::open(fine_job.path);
    if (!store || !fine)
    {
        return store ? fine.error().text : store.error().text;
    }
    const auto rows_of = [&](const char* part)
    {
        Row common = context.common_row(scene, part);
        common.hash = short_hash(store.value());
        return CaseRows(context.rows, common);
    };
    CaseRows encoder_rows = rows_of("Encoder");
    add_cost(encoder_rows, on_one.value(), on_two.value(), store.value().header().fields(),
             context.mesh.goals);
    CaseRows rows = rows_of("Files");
    add_content(rows, store.value(), fine.value(), context.mesh.goals);
    return add_reading(rows, store.value(), context);
}

} // namespace tactus::bench
