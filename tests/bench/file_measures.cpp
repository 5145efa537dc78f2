// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Measurements of the whole encoder and its files.

#include "host_tools/encode/write_spm.hpp"
#include "host_tools/mesh/prepare.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "rt_core/limits.hpp"
#include "tests/bench/child_process.hpp"
#include "tests/bench/encoder_cases.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/reading_speed.hpp"
#include "tests/shared/temporary_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

namespace tactus::bench
{

namespace
{

constexpr std::uint32_t kFineBits = 20;

struct EncodeJob
{
    std::filesystem::path path;
    std::uint32_t position_bits{kMinPositionBits};
    unsigned threads{1};     ///< Number of threads; a single one is pinned to one core.
    std::uint32_t passes{1}; ///< Passes, at least one.
};

/// Fastest run of the encoder, with the highest peak of all runs.
struct EncodeRun
{
    std::string scene;
    double prepare_s{0.0}; ///< Time from a mesh in memory.
    double simplify_s{0.0};
    double write_s{0.0}; ///< Time until the file is written.
    /// CPU time of all threads; less than the sum of the others if the process had to wait.
    double processor_s{0.0};
    std::uint64_t peak_bytes{0};

    [[nodiscard]] double total_s() const { return prepare_s + simplify_s + write_s; }
};

constexpr std::uint32_t kEncodedBaseFaces = 500;

/// Seconds since construction or the last call.
class Laps
{
public:
    double next()
    {
        const BenchClock::time_point before = std::exchange(last_, BenchClock::now());
        return seconds(before, last_);
    }

private:
    BenchClock::time_point last_ = BenchClock::now();
};

/// One run, in the child: its times in seconds, then the scene's name.
std::string encode(NamedMesh source, const EncodeJob& job)
{
    const std::clock_t processor_start = std::clock();
    Laps laps;
    PrepareOptions prepare_options;
    prepare_options.position_bits = job.position_bits;
    const PreparedMesh prepared = needed(prepare_mesh(source.mesh, prepare_options));
    source.mesh = {};
    const double prepare_s = laps.next();
    SimplifyOptions options;
    options.base_faces = kEncodedBaseFaces;
    options.threads = job.threads;
    const auto simplified = needed(simplify(prepared.mesh, options));
    const double simplify_s = laps.next();
    needed(write_spm(job.path, prepared, simplified,
                     {job.position_bits, kMaxBaseFaces, std::nullopt}));
    const double write_s = laps.next();
    const auto processor_s =
        static_cast<double>(std::clock() - processor_start) / static_cast<double>(CLOCKS_PER_SEC);
    return fmt::format("{} {} {} {} {}", prepare_s, simplify_s, write_s, processor_s, source.name);
}

std::string make_and_encode(const EncoderContext& context, const EncodeJob& job)
{
    std::optional<PinnedCore> pinned;
    if (job.threads == 1)
    {
        pinned.emplace(context.options.core);
    }
    auto source = context.mesh.make();
    return encode(std::move(source), job);
}

/// Encodes the context's mesh as spm_build does, each pass in its own process. A base mesh larger
/// than usual is still written, to have its figures.
EncodeRun encode_in_child(const EncoderContext& context, const EncodeJob& job)
{
    EncodeRun best;
    for (std::uint32_t pass = 0; pass < job.passes; ++pass)
    {
        const auto outcome = run_in_child([&] { return make_and_encode(context, job); });
        EncodeRun run;
        std::istringstream(outcome.text) >> run.prepare_s >> run.simplify_s >> run.write_s >>
            run.processor_s >> run.scene;
        const std::uint64_t peak_bytes = std::max(outcome.peak_bytes, best.peak_bytes);
        if (pass == 0 || run.total_s() < best.total_s())
        {
            best = run;
        }
        best.peak_bytes = peak_bytes;
    }
    return best;
}

std::string bytes_of(const std::filesystem::path& path)
{
    std::ifstream file(path, std::ios::binary);
    std::ostringstream bytes;
    bytes << file.rdbuf();
    return std::move(bytes).str();
}

/// Bytes of a file's hash tree.
double hash_bytes(const ModelCounts& counts)
{
    const std::size_t hashes =
        counts.chunks() + counts.index_pages() + std::size_t{1}; // The base mesh's hash.
    return static_cast<double>(hashes * sizeof(ContentHash) + kRootHashBytes);
}

/// First half of the model's hash, in the form of the rows.
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

void add_reading(CaseRows& rows, const ModelStore& store, const EncoderContext& context)
{
    const PinnedCore pinned(context.options.core);
    const auto speed = measure_reading(store, context.options.passes_or(7, 3));
    rows.add("parse", speed.parse_ns, "ns a record");
    rows.add("link", speed.link_ns, "ns a record");
    rows.add("both", speed.both_ns, "ns a record", context.mesh.goals.read_ns_per_record);
    rows.add("that is", 1e3 / speed.both_ns, "M records/s");
}

} // namespace

void measure_files(const EncoderContext& context)
{
    const test::TemporaryFolder folder("bench-encoder");
    const std::uint32_t passes = context.options.passes_or(3, 1);
    const EncodeJob job{folder.path() / "one.spm", kMinPositionBits, 1, passes};
    const EncodeJob job_on_two{folder.path() / "two.spm", kMinPositionBits, 2, passes};
    const EncodeJob fine_job{folder.path() / "fine.spm", kFineBits, 2, 1};
    const EncodeRun on_one = encode_in_child(context, job);
    const EncodeRun on_two = encode_in_child(context, job_on_two);
    encode_in_child(context, fine_job);
    const std::string& scene = on_one.scene;
    if (bytes_of(job.path) != bytes_of(job_on_two.path))
    {
        throw Failure(scene + ": one thread and two give different files");
    }
    const ModelStore store = needed(ModelStore::open(job.path));
    const ModelStore fine = needed(ModelStore::open(fine_job.path));
    const auto rows_of = [&](const char* part)
    {
        Row common = context.common_row(scene, part);
        common.hash = short_hash(store);
        return CaseRows(context.rows, common);
    };
    CaseRows encoder_rows = rows_of("Encoder");
    add_cost(encoder_rows, on_one, on_two, store.header().fields(), context.mesh.goals);
    CaseRows rows = rows_of("Files");
    add_content(rows, store, fine, context.mesh.goals);
    add_reading(rows, store, context);
}

} // namespace tactus::bench
