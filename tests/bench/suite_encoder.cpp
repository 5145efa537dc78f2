// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Suite `encoder`: our encoder on well-known and on difficult meshes, compared with the peers that
/// simplify. Lists the meshes with their goals.

#include "host_tools/encode/write_spm.hpp"
#include "host_tools/mesh/prepare.hpp"
#include "host_tools/shapes/shapes.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "rt_core/base/arena.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/spm/chunk_coding.hpp"
#include "rt_core/spm/linker.hpp"
#include "tests/bench/encoder_cases.hpp"
#include "tests/bench/first_contact.hpp"
#include "tests/bench/measuring.hpp"
#include "tests/bench/program.hpp"
#include "tests/bench/scenes.hpp"
#include "tests/bench/suites.hpp"
#include "tests/shared/certificate_refinement.hpp"
#include "tests/shared/temporary_folder.hpp"
#include "tests/shared/test_model.hpp"
#include "transport/store/model_store.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace tactus::bench
{
namespace
{

// Measurements of the whole encoder and its files.

/// Cost of one record on the transport thread: the least of several passes over a whole model.
struct ReadingSpeed
{
    double parse_ns{0.0};
    double link_ns{0.0};
    double both_ns{0.0}; ///< Parsing and linking in one pass: not exactly the sum of the others.
};

/// Whole model, coded and decoded.
class WholeModel
{
public:
    explicit WholeModel(const ModelStore& store)
        : header_(store.header())
        , coded_(header_.counts().chunks())
        , pages_(header_.counts().chunks())
        , positions_m_(header_.counts().base_vertices)
        , faces_(header_.counts().base_faces)
        , next_(header_.counts().base_faces)
    {
        Arena measure = Arena::measuring();
        static_cast<void>(LinkPool(measure, pages_.size()));
        memory_.resize(measure.used() / sizeof(Line));
    }

    void load(const ModelStore& store)
    {
        std::vector<std::byte> base;
        for (std::uint32_t chunk = 0; chunk < coded_.size(); ++chunk)
        {
            needed(store.read({ContentKind::chunk, chunk}, coded_[chunk]));
        }
        needed(store.read({ContentKind::base, 0}, base));
        if (!parse_base_mesh(base, header_, slots().base))
        {
            throw Failure(store.path().string() + ": bad base mesh");
        }
    }

    /// True if every chunk was accepted.
    [[nodiscard]] bool parse_all()
    {
        bool is_sound = true;
        for (std::uint32_t chunk = 0; chunk < pages_.size(); ++chunk)
        {
            is_sound &= bool{parse_chunk(coded_[chunk], header_, {chunk}, pages_[chunk])};
        }
        return is_sound;
    }

    [[nodiscard]] Linker make_linker()
    {
        std::fill(next_.begin(), next_.end(), kNextPending);
        Arena arena(std::as_writable_bytes(std::span(memory_)));
        pool_.emplace(arena, pages_.size());
        return {*pool_, 0, header_, slots()};
    }

    /// True if every record was linked.
    [[nodiscard]] bool link_all(Linker& linker) const
    {
        for (std::uint32_t chunk = 0; chunk < pages_.size(); ++chunk)
        {
            linker.link_page({chunk}, chunk);
        }
        return linker.records_linked() == header_.counts().records;
    }

private:
    struct alignas(Arena::kAlignment) Line
    {
        std::array<std::byte, Arena::kAlignment> bytes;
    };

    [[nodiscard]] PageSlots slots() { return {pages_, {}, {positions_m_, faces_, next_}}; }

    const ModelHeader& header_;
    std::vector<std::vector<std::byte>> coded_;
    std::vector<Page> pages_;
    std::vector<Vec3f> positions_m_;
    std::vector<BaseFace> faces_;
    std::vector<std::uint32_t> next_;
    std::vector<Line> memory_;
    std::optional<LinkPool> pool_;
};

/// Parses all chunks of a model, then links all pages, on the calling thread, `passes` times. The
/// coded bytes are in memory and their hashes already checked. A failure if a record does not link
/// or the model has none. 150 B a face.
ReadingSpeed measure_reading(const ModelStore& store, std::uint32_t passes)
{
    const std::string name = store.path().string();
    const std::uint32_t records = store.header().counts().records;
    if (records == 0)
    {
        throw Failure(name + ": has no records to read");
    }
    WholeModel model(store);
    model.load(store);
    constexpr double kNever = std::numeric_limits<double>::infinity();
    ReadingSpeed least{kNever, kNever, kNever};
    for (std::uint32_t pass = 0; pass < passes; ++pass)
    {
        const BenchClock::time_point start = BenchClock::now();
        const bool is_parsed = model.parse_all();
        const BenchClock::time_point parsed = BenchClock::now();
        Linker linker = model.make_linker();
        const BenchClock::time_point ready = BenchClock::now();
        const bool is_linked = model.link_all(linker);
        const BenchClock::time_point linked = BenchClock::now();
        if (!is_parsed || !is_linked)
        {
            throw Failure(name + ": not all of its records can be read");
        }
        const double parse_ns = 1e9 * seconds(start, parsed) / records;
        const double link_ns = 1e9 * seconds(ready, linked) / records;
        least.parse_ns = std::min(least.parse_ns, parse_ns);
        least.link_ns = std::min(least.link_ns, link_ns);
        least.both_ns = std::min(least.both_ns, parse_ns + link_ns);
    }
    return least;
}

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

/// The whole encoder, from a mesh in memory to a file, each run in its own process: time, memory,
/// content and reading speed of the file. One thread and two give the same bytes.
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

// Tightness of the bounds, and the cost of a first contact that follows from it.

constexpr std::uint32_t kCertifiedBaseFaces = 500;
/// Radius of the tool as a share of the diagonal.
constexpr double kRadius = 0.01;

void add_tightness(CaseRows& rows, const PreparedMesh& prepared,
                   const Simplification& simplification, const EncoderContext& context)
{
    const std::size_t points = context.options.quick ? 200'000 : 2'000'000;
    const std::size_t faces = prepared.mesh.faces.size();
    const auto coarse = test::measure_certificate(prepared, simplification, faces / 6, points);
    const auto fine = test::measure_certificate(prepared, simplification, 2 * faces / 3, points);
    rows.add("largest at n/6", coarse.max_ratio(), "x true", context.mesh.goals.bound_at_sixth);
    rows.add("largest at 2n/3", fine.max_ratio(), "x true", context.mesh.goals.bound_at_two_thirds);
    rows.add("mean at n/6", coarse.face_ratio_mean, "x true");
    rows.add("mean at 2n/3", fine.face_ratio_mean, "x true");
}

void add_splits(CaseRows& rows, const DecodedModel& model, const std::vector<test::Face>& source,
                double radius_m, const EncoderContext& context)
{
    const ExactSplits exact = measure_exact_splits(model, source, test::FaceTree(source), radius_m,
                                                   context.options.quick ? 100 : 500, kSeed);
    rows.add("splits to an exact distance, median", exact.splits.p50, "",
             context.mesh.goals.exact_splits);
    rows.add("splits, 90 %", exact.splits.p90, "");
    rows.add("most splits", exact.splits.max, "");
}

void add_contact(CaseRows& rows, const ModelStore& store, const DecodedModel& model,
                 const std::vector<test::Face>& source, double radius_m,
                 const EncoderContext& context)
{
    const auto contact = measure_first_contact(store, model, source, radius_m,
                                               context.options.quick ? 100 : 300, kSeed);
    const EncoderGoals& goals = context.mesh.goals;
    rows.add("median", contact.all_bytes.p50 / 1e3, "KB", goals.contact_kb);
    rows.add("90 %", contact.all_bytes.p90 / 1e3, "KB");
    rows.add("with hashes, median", contact.all_hashed_bytes.p50 / 1e3, "KB",
             goals.hashed_contact_kb);
    rows.add("of it base", contact.base_bytes / 1e3, "KB");
    rows.add("header", contact.header_bytes / 1e3, "KB");
    rows.add("index", contact.index_bytes.p50 / 1e3, "KB");
    rows.add("chunks", contact.chunk_bytes.p50 / 1e3, "KB");
    rows.add("number of chunks", contact.chunks.p50, "");
}

/// Ratio of the bounds to the true errors, splits until a distance is exact, and bytes of a first
/// contact, for a tool radius of 1 % of the diagonal.
void measure_bounds(const EncoderContext& context)
{
    const auto named = context.mesh.make();
    const auto prepared = needed(prepare_mesh(named.mesh, {}));
    const auto simplification = needed(simplify(prepared.mesh, {kCertifiedBaseFaces, 2, {}}));
    const auto rows_of = [&](const char* part)
    { return CaseRows(context.rows, context.common_row(named.name, part)); };
    CaseRows bounds = rows_of("Bounds");
    add_tightness(bounds, prepared, simplification, context);

    const test::TemporaryFolder folder("bench-bounds");
    EncodeOptions options;
    options.base_faces = kMaxBaseFaces;
    options.threads = 2;
    needed(write_spm(folder.path() / "model.spm", prepared, simplification, options));
    const auto store = needed(ModelStore::open(folder.path() / "model.spm"));
    const DecodedModel model = decode_all(store);
    const std::vector<test::Face> source = test::faces_on_grid(prepared);
    const double radius_m = kRadius * prepared.diagonal_m;
    add_splits(bounds, model, source, radius_m, context);
    CaseRows contact = rows_of("First exact contact");
    add_contact(contact, store, model, source, radius_m, context);
}

/// 1.3 million records a second.
constexpr double kReadGoal_ns = 1e3 / 1.3;

using MakeMesh = std::function<NamedMesh()>;

MakeMesh from(const SceneSource& source)
{
    return [source] { return source_mesh(source); };
}

MakeMesh shape(Shape shape, std::uint32_t faces)
{
    return [shape, faces]
    {
        const std::string name(shape_names()[static_cast<std::size_t>(shape)]);
        return NamedMesh(
            NamedMesh{fmt::format("{}-{}", name, faces), make_shape(shape, faces).value()});
    };
}

MakeMesh uv_sphere(std::uint32_t rings, std::uint32_t segments)
{
    return [rings, segments]
    {
        return NamedMesh(NamedMesh{fmt::format("uv-sphere-{}x{}", rings, segments),
                                   make_uv_sphere(rings, segments).value()});
    };
}

/// Goals of every mesh.
EncoderGoals usual_goals()
{
    EncoderGoals goals;
    goals.us_per_face = 18.0;
    goals.us_per_face_on_two = 10.0;
    goals.read_ns_per_record = kReadGoal_ns;
    goals.base_faces = 500.0;
    goals.bound_at_sixth = 1.4;
    goals.bound_at_two_thirds = 3.5;
    return goals;
}

/// Additional goals of the well-known meshes; none for their stand-ins.
EncoderGoals known_goals()
{
    EncoderGoals goals = usual_goals();
    if (std::getenv("TACTUS_MESHES") != nullptr)
    {
        goals.rms_to_garland_heckbert = 1.15;
        goals.max_to_garland_heckbert = 1.0;
        goals.rms_to_meshoptimizer = 0.75;
    }
    return goals;
}

EncoderGoals with_size(EncoderGoals goals, double bytes_per_face, double fine_bytes_per_face)
{
    goals.file_bytes_per_face = bytes_per_face;
    goals.fine_file_bytes_per_face = fine_bytes_per_face;
    return goals;
}

/// Goals from a million faces on, where fixed costs no longer hide the growth.
EncoderGoals large_goals()
{
    EncoderGoals goals = with_size(usual_goals(), 4.3, 5.1);
    goals.peak_bytes_per_face = 350.0;
    goals.exact_splits = 250.0;
    return goals;
}

EncoderGoals largest_goals()
{
    EncoderGoals goals = large_goals();
    goals.seconds = 90.0;
    goals.contact_kb = 80.0;
    goals.hashed_contact_kb = 110.0;
    return goals;
}

std::vector<EncoderMesh> all_meshes()
{
    constexpr SceneSource kCow{"cow", "cow.obj", 0, 5'804};
    constexpr SceneSource kTeapot{"teapot", "teapot.obj", 0, 6'320};
    constexpr SceneSource kFandiskMesh{"fandisk", "fandisk.obj", 0, 12'946};
    constexpr SceneSource kIgeaMesh{"igea", "igea.ply", 0, 268'686};
    const EncoderGoals known = known_goals();
    const EncoderGoals usual = usual_goals();
    const EncoderGoals scanned = with_size(known, 4.6, 5.4);
    const EncoderGoals large = large_goals();
    using enum When;
    return {
        {"cow", always, from(kCow), known},
        {"teapot", always, from(kTeapot), known},
        {"fandisk", always, from(kFandiskMesh), known, Feature::sharp_edges},
        {"bunny", always, from(kBunny), scanned, Feature::borders},
        {"igea", full_only, from(kIgeaMesh), scanned},
        {"sphere", full_only, shape(Shape::sphere, 81'920), usual},
        {"needles", always, uv_sphere(20, 4'000), usual, Feature::none, false},
        {"poles", full_only, uv_sphere(3, 4'000), usual, Feature::none, false},
        {"bumpy-1.1M", full_only, shape(Shape::bumpy_sphere, 1'100'000), large},
        {"bunny-1.1M", full_only, from(kFineBunny), large, Feature::borders},
        {"igea-4.3M", named_only, from(kFineIgea), largest_goals()},
        {"tiny-gear", named_only, shape(Shape::gear, 4'000), {}, Feature::sharp_edges},
        {"tiny-terrain", named_only, shape(Shape::terrain, 4'000), {}, Feature::borders},
    };
}

/// Parts of the suite in their order. Files are first, since processes that measure memory inherit
/// ours.
constexpr std::array kEncoderParts{measure_files, compare_simplifiers, measure_bounds};

void run_mesh(const CaseContext& context, const EncoderMesh& mesh)
{
    for (const auto& run_part : kEncoderParts)
    {
        run_part({context, mesh});
    }
}

std::vector<Case> encoder_cases()
{
    std::vector<Case> cases;
    for (const EncoderMesh& mesh : all_meshes())
    {
        cases.push_back(make_case(mesh.name, mesh.when, run_mesh, mesh));
    }
    return cases;
}

} // namespace

Suite encoder_suite()
{
    return {"encoder", encoder_cases};
}

} // namespace tactus::bench
