// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

#include "tests/bench/first_contact.hpp"

#include "tests/bench/measuring.hpp"
#include "tests/shared/certificate_refinement.hpp"
#include "tests/shared/influence_index.hpp"
#include "tests/shared/random.hpp"
#include "tests/shared/surface_points.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

namespace tactus::bench
{
namespace
{

constexpr double kHashBytes = sizeof(ContentHash);

/// Counts by contact.
struct Counted
{
    std::vector<double> index, index_hashes, chunks, chunk_bytes, needed, splits;
    std::uint64_t missed{0};
};

/// Hashes of the base mesh, the index pages and the model.
double header_hash_bytes(const ModelHeader& header)
{
    return kHashBytes + kHashBytes * header.counts().index_pages() + kRootHashBytes;
}

double bytes_of(const ModelStore& store, ContentKind kind, std::uint32_t number)
{
    return static_cast<double>(store.coded_bytes({kind, number}));
}

void count_named(const ModelStore& store, const test::InfluenceIndex::Named& named,
                 Counted& counted)
{
    double index = 0.0;
    double hashes = 0.0;
    double chunks = 0.0;
    for (const IndexPageId page : named.pages)
    {
        index += bytes_of(store, ContentKind::index_page, page.value);
        hashes += kHashBytes * chunks_in_index_page(store.header().counts(), page);
    }
    for (const ChunkId chunk : named.chunks)
    {
        chunks += bytes_of(store, ContentKind::chunk, chunk.value);
    }
    counted.index.push_back(index - hashes);
    counted.index_hashes.push_back(hashes);
    counted.chunks.push_back(static_cast<double>(named.chunks.size()));
    counted.chunk_bytes.push_back(chunks);
}

void count_needed(const ModelStore& store, const std::vector<RecordId>& splits,
                  const std::vector<ChunkId>& named, Counted& counted)
{
    std::set<ChunkId> needed;
    std::transform(splits.begin(), splits.end(), std::inserter(needed, needed.end()), chunk_of);
    double bytes = 0.0;
    for (const ChunkId chunk : needed)
    {
        bytes += bytes_of(store, ContentKind::chunk, chunk.value);
        counted.missed += std::binary_search(named.begin(), named.end(), chunk) ? 0U : 1U;
    }
    counted.needed.push_back(bytes);
    counted.splits.push_back(static_cast<double>(splits.size()));
}

FirstContactFigures figures_of(const ModelStore& store, const Counted& counted)
{
    const HeaderFields& fields = store.header().fields();
    FirstContactFigures figures;
    const double header_hashes = header_hash_bytes(store.header());
    figures.header_bytes = static_cast<double>(fields.header_bytes) - header_hashes;
    figures.base_bytes = static_cast<double>(fields.base_bytes);
    std::vector<double> all;
    std::vector<double> all_hashed;
    for (std::size_t i = 0; i < counted.index.size(); ++i)
    {
        all.push_back(figures.header_bytes + figures.base_bytes + counted.index[i] +
                      counted.chunk_bytes[i]);
        all_hashed.push_back(all.back() + header_hashes + counted.index_hashes[i]);
    }
    figures.index_bytes = contact_spread_of(counted.index);
    figures.chunk_bytes = contact_spread_of(counted.chunk_bytes);
    figures.all_bytes = contact_spread_of(all);
    figures.all_hashed_bytes = contact_spread_of(all_hashed);
    figures.chunks = contact_spread_of(counted.chunks);
    figures.needed_bytes = contact_spread_of(counted.needed);
    figures.splits = contact_spread_of(counted.splits);
    figures.missed_chunks = counted.missed;
    return figures;
}

} // namespace

ContactSpread contact_spread_of(const std::vector<double>& values)
{
    return {quantile(values, 0.5), quantile(values, 0.9), quantile(values, 1.0)};
}

FirstContactFigures measure_first_contact(const ModelStore& store, const DecodedModel& model,
                                          const std::vector<test::Face>& source, double radius_m,
                                          std::uint32_t contacts, std::uint64_t seed)
{
    const test::InfluenceIndex index(store);
    const test::CertificateRefinement refinement(model);
    test::SurfacePoints surface(source, seed);
    Counted counted;
    for (std::uint32_t i = 0; i < contacts; ++i)
    {
        const Vec3 place_m = surface.draw_by_area();
        const auto named = index.named_by(SphereZone{place_m, radius_m});
        count_named(store, named, counted);
        count_needed(store, refinement.certify_sphere(place_m, radius_m).splits, named.chunks,
                     counted);
    }
    return figures_of(store, counted);
}

ExactSplits measure_exact_splits(const DecodedModel& model, const std::vector<test::Face>& source,
                                 const test::FaceTree& tree, double radius_m, std::uint32_t probes,
                                 std::uint64_t seed)
{
    const test::CertificateRefinement refinement(model);
    test::SurfacePoints surface(source, seed);
    std::vector<double> splits;
    ExactSplits figures;
    for (std::uint32_t i = 0; i < probes; ++i)
    {
        const Vec3 direction(test::signed_unit(seed, 4 * i), test::signed_unit(seed, 4 * i + 1),
                             test::signed_unit(seed, 4 * i + 2));
        const double way_m = 2.0 * radius_m * std::abs(test::signed_unit(seed, 4 * i + 3));
        const Vec3 place_m = surface.draw_by_area() + way_m * direction.normalized();
        const auto answer = refinement.find_distance(place_m);
        splits.push_back(static_cast<double>(answer.splits.size()));
        figures.distance_error_max_m =
            std::max(figures.distance_error_max_m,
                     std::abs(answer.distance_m - tree.nearest(place_m).distance_m));
    }
    figures.splits = contact_spread_of(splits);
    return figures;
}

} // namespace tactus::bench
