// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/false_claims.hpp"

#include "host_tools/encode/influence.hpp"
#include "host_tools/encode/region_grid.hpp"
#include "host_tools/encode/replay.hpp"
#include "rt_core/math/triangle.hpp"
#include "rt_core/spm/chunk_coding.hpp"
#include "rt_core/spm/error_code.hpp"
#include "rt_core/spm/index_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <span>

namespace tactus
{

namespace
{

/// Tolerance of distances: above their rounding, below any bound except zero.
constexpr double kSlack_quanta = 1e-3;
/// Number of cuts. The first one splits no record, the last one half of them.
constexpr std::uint32_t kCuts = 10;
constexpr std::size_t kFacesInBucket = 8;

bool holds(const QuantumBox& box, const QuantumBox& inner)
{
    bool does = true;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        does = does && box.low[axis] <= inner.low[axis] && box.high[axis] >= inner.high[axis];
    }
    return does;
}

/// Box extended by one quantum on every side, the margin that find_influence() adds.
QuantumBox grown(QuantumBox box)
{
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        --box.low[axis];
        ++box.high[axis];
    }
    return box;
}

std::string text_of(const QuantumBox& box)
{
    return fmt::format("({}) to ({})", fmt::join(box.low, ", "), fmt::join(box.high, ", "));
}

/// Finds the faces of a cut near a point: the model's longest axis is divided into slabs.
class Slabs
{
public:
    Slabs(double extent, std::size_t axis) : axis_(axis), width_(extent / kSlabs + 1.0) {}

    void add(std::uint32_t face, const QuantumBox& box)
    {
        for (std::size_t i = slab_of(box.low[axis_]); i <= slab_of(box.high[axis_]); ++i)
        {
            faces_[i].push_back(face);
        }
    }
    [[nodiscard]] const std::vector<std::uint32_t>& near(const Vec3& place) const
    {
        return faces_[slab_of(place[static_cast<int>(axis_)])];
    }

private:
    static constexpr std::size_t kSlabs = 256;

    [[nodiscard]] std::size_t slab_of(double coordinate) const
    {
        const double slab = coordinate / width_;
        return slab <= 0.0 ? 0 : std::min(static_cast<std::size_t>(slab), kSlabs - 1);
    }

    std::size_t axis_;
    double width_;
    std::array<std::vector<std::uint32_t>, kSlabs> faces_;
};

class Check
{
public:
    Check(const ModelStore& store, const DecodedModel& model, const ClaimCheck& check)
        : store_(store)
        , model_(model)
        , check_(check)
        , fields_(model.header().fields())
        , counts_(model.header().counts())
        , order_(in_dependency_order(model))
        , boxes_(counts_.records, kEmptyBox)
    {
    }

    ClaimsFound run()
    {
        if (auto fault = refine())
        {
            found_.contradiction = std::move(*fault);
            return std::move(found_);
        }
        check_counts();
        check_closed();
        check_extent();
        check_buckets();
        check_largest_error();
        check_regions();
        check_boxes();
        check_bounds();
        return std::move(found_);
    }

private:
    template <typename... Arguments>
    void tell(fmt::format_string<Arguments...> format, Arguments&&... arguments)
    {
        found_.false_claims.push_back(fmt::format(format, std::forward<Arguments>(arguments)...));
    }
    template <typename T>
    void compare(const char* what, T stated, T is)
    {
        if (stated != is)
        {
            tell("header: {} is stated as {}; it is {}", what, stated, is);
        }
    }

    /// Position of a vertex, in quanta; exact, since a quantum is a power of two.
    [[nodiscard]] GridPoint place_of(VertexId vertex) const
    {
        const Vec3f& at_m = model_.position_m(vertex);
        GridPoint place{};
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            place[axis] = static_cast<std::int32_t>(at_m[axis] / model_.header().quantum_m());
        }
        return place;
    }
    [[nodiscard]] Vec3 vec_of(VertexId vertex) const
    {
        const GridPoint place = place_of(vertex);
        return {static_cast<double>(place[0]), static_cast<double>(place[1]),
                static_cast<double>(place[2])};
    }

    /// Box of a face in the replay's state, inflated by a bound.
    [[nodiscard]] QuantumBox box_of(const Replay& replay, FaceId face, ErrorCode error) const
    {
        const double quanta = std::ceil(static_cast<double>(error_in_quanta(error)));
        const auto margin = static_cast<std::int32_t>(std::min(quanta, 0x1p28));
        QuantumBox box = kEmptyBox;
        for (const VertexId corner : replay.corners(face))
        {
            const GridPoint place = place_of(corner);
            join(box, {place, place});
        }
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            box.low[axis] -= margin;
            box.high[axis] += margin;
        }
        return box;
    }

    /// Splits all records; stores the influence box of each, and the source mesh. Returns a fault,
    /// if any.
    std::optional<std::string> refine()
    {
        Replay replay(model_);
        for (const RecordId id : order_)
        {
            const VsplitRecord& record = model_.record(id);
            QuantumBox& box = boxes_[id.value];
            for (std::uint32_t i = 0; i < record.fan_size; ++i)
            {
                const FaceId face = record.star[2 + i];
                if (replay.is_active(face)) // Otherwise the split is refused.
                {
                    join(box, box_of(replay, face, model_.error_of(face, record.before[i])));
                }
            }
            if (auto fault = replay.split(id))
            {
                return fault;
            }
            for (std::uint32_t place = 0; place < record.star_end(); ++place)
            {
                if (!record.star[place].is_none())
                {
                    join(box, box_of(replay, record.star[place], record.error[place]));
                }
            }
            check_.progress(++done_);
        }
        for (auto id = order_.rbegin(); id != order_.rend(); ++id)
        {
            const VsplitRecord& record = model_.record(*id);
            for (std::uint32_t i = 0; i < record.fan_size; ++i)
            {
                if (!record.before[i].is_base())
                {
                    join(boxes_[record.before[i].record().value], boxes_[id->value]);
                }
            }
        }
        keep_mesh(replay);
        return std::nullopt;
    }

    void keep_mesh(const Replay& replay)
    {
        for (std::uint32_t vertex = 0; vertex < counts_.vertices(); ++vertex)
        {
            mesh_.positions.push_back(place_of({vertex}));
        }
        for (std::uint32_t face = 0; face < counts_.face_ids(); ++face)
        {
            if (replay.is_active({face}))
            {
                const auto& corners = replay.corners({face});
                mesh_.faces.push_back({corners[0].value, corners[1].value, corners[2].value});
                faces_.push_back({face});
            }
        }
    }

    void check_counts()
    {
        std::vector<bool> is_used(mesh_.positions.size());
        for (const auto& corners : mesh_.faces)
        {
            for (const std::uint32_t corner : corners)
            {
                is_used[corner] = true;
            }
        }
        compare("the number of faces", fields_.source_faces,
                static_cast<std::uint32_t>(mesh_.faces.size()));
        compare("the number of vertices", fields_.source_vertices,
                static_cast<std::uint32_t>(std::ranges::count(is_used, true)));
        std::uint32_t depth = 0;
        for (const RecordId id : order_)
        {
            depth = std::max<std::uint32_t>(depth, model_.record(id).depth);
        }
        compare("the depth", fields_.max_depth, depth);
    }

    /// Checks the claim that the mesh is closed. A closed mesh may be cut open where both sides
    /// coincide.
    void check_closed()
    {
        // First vertex with the same position, by vertex.
        std::vector<std::uint32_t> first(mesh_.positions.size());
        std::iota(first.begin(), first.end(), 0U);
        if (model_.header().is_closed())
        {
            std::vector<std::uint32_t> by_place = first;
            std::ranges::stable_sort(by_place, {},
                                     [&](std::uint32_t vertex) { return mesh_.positions[vertex]; });
            for (std::size_t i = 1; i < by_place.size(); ++i)
            {
                if (mesh_.positions[by_place[i]] == mesh_.positions[by_place[i - 1]])
                {
                    first[by_place[i]] = first[by_place[i - 1]];
                }
            }
        }
        const std::optional<std::uint32_t> border = find_border(first);
        if (model_.header().is_closed() && border)
        {
            const Vec3 at_m = source_m(vec_of({*border}));
            tell(
                "header: the mesh is stated as closed; it has a border at ({:.6g}, {:.6g}, {:.6g})",
                at_m.x(), at_m.y(), at_m.z());
        }
        if (!model_.header().is_closed() && !border)
        {
            tell("header: the mesh is stated as open; it is closed");
        }
    }
    /// First end of a border edge, which no face has in the opposite direction; none if there is
    /// none.
    [[nodiscard]] std::optional<std::uint32_t>
    find_border(std::span<const std::uint32_t> vertex_of) const
    {
        std::vector<std::uint64_t> edges;
        for (const auto& corners : mesh_.faces)
        {
            for (std::size_t i = 0; i < 3; ++i)
            {
                edges.push_back(std::uint64_t{vertex_of[corners[i]]} << 32U |
                                vertex_of[corners[(i + 1) % 3]]);
            }
        }
        std::ranges::sort(edges);
        const auto has_no_other = [&](std::uint64_t edge)
        { return !std::ranges::binary_search(edges, edge << 32U | edge >> 32U); };
        const auto open = std::ranges::find_if(edges, has_no_other);
        return open == edges.end() ? std::nullopt
                                   : std::optional(static_cast<std::uint32_t>(*open));
    }

    void check_extent()
    {
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            std::int32_t most = 0;
            for (const GridPoint& place : mesh_.positions)
            {
                most = std::max(most, place[axis]);
            }
            compare(std::array{"the extent in x", "the extent in y", "the extent in z"}[axis],
                    fields_.extent_quanta[axis], static_cast<std::uint32_t>(most));
        }
    }

    /// Checks the buckets: uneven ones would deepen the controller's tree.
    void check_buckets()
    {
        const std::size_t buckets = (faces_.size() + kFacesInBucket - 1) / kFacesInBucket;
        std::vector<std::size_t> members(buckets);
        for (const FaceId face : faces_)
        {
            const std::uint32_t bucket = bucket_of(face);
            if (bucket >= buckets)
            {
                tell("face {}: is in bucket {}, but there are {} buckets", face.value, bucket,
                     buckets);
                return;
            }
            ++members[bucket];
        }
        for (std::size_t i = 0; i < buckets; ++i)
        {
            const std::size_t right = std::min(kFacesInBucket, faces_.size() - i * kFacesInBucket);
            if (members[i] != right)
            {
                tell("bucket {}: has {} faces instead of {}", i, members[i], right);
                return;
            }
        }
    }
    [[nodiscard]] std::uint32_t bucket_of(FaceId face) const
    {
        if (face.value < counts_.base_faces)
        {
            return model_.base_faces()[face.value].bucket;
        }
        const std::uint32_t place = face.value - counts_.base_faces;
        return model_.record({place / 2}).bucket[place % 2];
    }

    void check_largest_error()
    {
        ErrorCode largest = 0;
        for (const BaseFace& face : model_.base_faces())
        {
            largest = std::max(largest, face.error);
        }
        for (const RecordId id : order_)
        {
            const VsplitRecord& record = model_.record(id);
            largest = std::max(largest, *std::ranges::max_element(record.error));
        }
        const double quanta = std::ceil(static_cast<double>(error_in_quanta(largest)));
        compare("the largest error bound in quanta", fields_.max_error_quanta,
                static_cast<std::uint32_t>(std::min(quanta, 0x1p31)));
    }

    void check_regions()
    {
        RegionGrid grid;
        grid.cell_quanta = fields_.region_cell_quanta;
        grid.cells = fields_.region_grid;
        mark_occupied(grid, mesh_);
        for (std::uint32_t region = 0; region < model_.header().region_count(); ++region)
        {
            const bool is =
                (grid.occupied[region / 8] & std::byte{1} << (region % 8)) != std::byte{0};
            if (is != model_.header().is_occupied({region}))
            {
                tell("region {}: is stated as {}; it is {}", region, is ? "empty" : "occupied",
                     is ? "occupied" : "empty");
                return;
            }
        }
    }

    /// Checks the boxes of index pages and chunks. Reports the first one that omits a part of its
    /// content, or that is too large: such a chunk is fetched though no tool needs it.
    void check_boxes()
    {
        std::vector<std::byte> coded;
        IndexPage page;
        std::array<ChunkEntry, kChunksPerIndexPage> entries;
        for (std::uint32_t i = 0; i < counts_.index_pages(); ++i)
        {
            // Both steps succeeded when the file was opened and decoded.
            if (!store_.read({ContentKind::index_page, i}, coded) ||
                !parse_index_page(coded, counts_, {i}, page, entries))
            {
                tell("index page {}: can no longer be read", i);
                return;
            }
            const QuantumBox stated = model_.header().index_entry({i}).box;
            QuantumBox all = kEmptyBox;
            for (std::uint32_t at = 0; at < page.chunks; ++at)
            {
                join(all, needed_by({(i << kChunksPerIndexPageLog2) + at}));
            }
            if (!holds(grown(all), stated))
            {
                tell("index page {}: its box in the header is {}; its records need {} quanta", i,
                     text_of(stated), text_of(all));
                return;
            }
            for (std::uint32_t at = 0; at < page.chunks; ++at)
            {
                const std::uint32_t chunk = (i << kChunksPerIndexPageLog2) + at;
                const QuantumBox needed = needed_by({chunk});
                const QuantumBox box = in_quanta(stated, page.box(at));
                const bool is_in_page = holds(stated, needed);
                if (!is_in_page || !holds(box, needed) || !holds(largest(stated, needed), box))
                {
                    tell("chunk {}: its influence box {}is {}; its records need {} quanta", chunk,
                         is_in_page ? "" : "in the header ", text_of(is_in_page ? box : stated),
                         text_of(needed));
                    return;
                }
            }
        }
    }
    /// Largest box that a file may have for `needed`: with its margin, clipped to the page's box,
    /// rounded as in the format.
    [[nodiscard]] static QuantumBox largest(const QuantumBox& page, const QuantumBox& needed)
    {
        QuantumBox box = grown(needed);
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            box.low[axis] = std::max(box.low[axis], page.low[axis]);
            box.high[axis] = std::min(box.high[axis], page.high[axis]);
        }
        return in_quanta(page, relative_to(page, box));
    }
    [[nodiscard]] QuantumBox needed_by(ChunkId chunk) const
    {
        QuantumBox box = kEmptyBox;
        for (std::uint32_t i = 0; i < records_in_chunk(counts_, chunk); ++i)
        {
            join(box, boxes_[(chunk.value << kRecordsPerChunkLog2) + i]);
        }
        return box;
    }
    [[nodiscard]] static QuantumBox in_quanta(const QuantumBox& page, const InfluenceBox& box)
    {
        const auto place = [&](std::uint16_t steps, std::size_t axis)
        {
            const std::int64_t step = index_step(page.low[axis], page.high[axis]);
            const std::int64_t most = std::numeric_limits<std::int32_t>::max();
            return static_cast<std::int32_t>(std::min(page.low[axis] + steps * step, most));
        };
        QuantumBox in_quanta;
        for (std::size_t axis = 0; axis < 3; ++axis)
        {
            in_quanta.low[axis] = place(box.low[axis], axis);
            in_quanta.high[axis] = place(box.high[axis], axis);
        }
        return in_quanta;
    }

    /// Checks points of the source against cuts: with no record split, a 512th of them, a 256th,
    /// ... a half.
    void check_bounds()
    {
        const std::vector<Vec3> places = sample();
        Replay replay(model_);
        std::size_t split = 0;
        for (std::uint32_t cut = 0; cut < kCuts; ++cut)
        {
            const std::size_t end = cut == 0 ? 0 : order_.size() >> (kCuts - cut);
            for (; split < end; ++split)
            {
                // The split succeeds, as it did in refine().
                static_cast<void>(replay.split(order_[split]));
                check_.progress(++done_);
            }
            if (!hold(replay, places))
            {
                return;
            }
        }
    }

    /// Sample points, one a face or one for several faces: corners, sides and interiors in turn.
    [[nodiscard]] std::vector<Vec3> sample() const
    {
        constexpr std::array<std::array<double, 3>, 4> kWeights{
            {{1.0, 0.0, 0.0}, {0.5, 0.5, 0.0}, {1.0 / 3, 1.0 / 3, 1.0 / 3}, {0.1, 0.2, 0.7}}};
        const std::size_t count = std::min(check_.places, mesh_.faces.size());
        std::vector<Vec3> places;
        for (std::size_t i = 0; i < count; ++i)
        {
            const auto& face = mesh_.faces[i * mesh_.faces.size() / count];
            Vec3 place(0.0, 0.0, 0.0);
            for (std::size_t corner = 0; corner < 3; ++corner)
            {
                place += kWeights[i % kWeights.size()][corner] * vec_of({face[corner]});
            }
            places.push_back(place);
        }
        return places;
    }

    /// True if each point is within the bound of a face of the cut; reports the first that is not.
    [[nodiscard]] bool hold(const Replay& replay, const std::vector<Vec3>& places)
    {
        const auto longest = std::ranges::max_element(fields_.extent_quanta);
        const auto axis = static_cast<std::size_t>(longest - fields_.extent_quanta.begin());
        Slabs slabs(*longest, axis);
        for (std::uint32_t face = 0; face < counts_.face_ids(); ++face)
        {
            if (replay.is_active({face}))
            {
                slabs.add(face, box_of(replay, {face}, error_of(replay, {face})));
            }
        }
        for (const Vec3& place : places)
        {
            // Least distance to a face, less its bound.
            double least = std::numeric_limits<double>::infinity();
            for (const std::uint32_t face : slabs.near(place))
            {
                const double bound = static_cast<double>(error_in_quanta(error_of(replay, {face})));
                least = std::min(least, distance(replay, {face}, place) - bound);
                if (least <= kSlack_quanta)
                {
                    break;
                }
            }
            if (least > kSlack_quanta)
            {
                const Vec3 at_m = source_m(place);
                tell("error bounds: the surface point ({:.6g}, {:.6g}, {:.6g}) is {} of a mesh of "
                     "{} faces",
                     at_m.x(), at_m.y(), at_m.z(),
                     std::isfinite(least)
                         ? fmt::format("{:.3g} m beyond the bounds",
                                       least * static_cast<double>(model_.header().quantum_m()))
                         : std::string("far beyond the bounds"),
                     replay.face_count());
                return false;
            }
        }
        return true;
    }
    [[nodiscard]] ErrorCode error_of(const Replay& replay, FaceId face) const
    {
        return model_.error_of(face, replay.state(face));
    }
    [[nodiscard]] double distance(const Replay& replay, FaceId face, const Vec3& place) const
    {
        const auto& corners = replay.corners(face);
        const Triangle triangle{vec_of(corners[0]), vec_of(corners[1]), vec_of(corners[2])};
        return (closest_point_on_triangle(place, triangle).point - place).norm();
    }
    [[nodiscard]] Vec3 source_m(const Vec3& quanta) const
    {
        return model_.header().origin_m() +
               static_cast<double>(model_.header().quantum_m()) * quanta;
    }

    const ModelStore& store_;
    const DecodedModel& model_;
    const ClaimCheck& check_;
    const HeaderFields& fields_;
    const ModelCounts counts_;
    const std::vector<RecordId> order_;
    std::vector<QuantumBox> boxes_; ///< Influence boxes by record, including those of dependents.
    QuantisedMesh mesh_;            ///< Mesh of the source; vertices by their ids.
    std::vector<FaceId> faces_;     ///< Ids of the faces of `mesh_`, in their order.
    std::size_t done_{0};
    ClaimsFound found_;
};

} // namespace

ClaimsFound find_false_claims(const ModelStore& store, const DecodedModel& model,
                              const ClaimCheck& check)
{
    return Check(store, model, check).run();
}

} // namespace tactus
