// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// Tightness of the bounds, and the cost of a first contact that follows from it.

#include "host_tools/encode/write_spm.hpp"
#include "host_tools/mesh/prepare.hpp"
#include "host_tools/simplify/simplify.hpp"
#include "tests/bench/encoder_cases.hpp"
#include "tests/bench/exact_splits.hpp"
#include "tests/bench/first_contact.hpp"
#include "tests/shared/certificate_figures.hpp"
#include "tests/shared/temporary_folder.hpp"
#include "tests/shared/test_model.hpp"

namespace tactus::bench
{

namespace
{

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

} // namespace

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

} // namespace tactus::bench
