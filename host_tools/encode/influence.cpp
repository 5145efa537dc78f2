// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/influence.hpp"

#include "rt_core/base/assert.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

namespace
{

using Corners = std::array<std::uint32_t, 3>;

/// Margin of a box for an error bound, in quanta: the bound rounded up, plus one for the rounding
/// of sphere tests. The maximum, 2^28, keeps boxes within 32 bits; no real bound approaches it.
std::int32_t margin_of(ErrorCode error)
{
    const double quanta = std::ceil(static_cast<double>(error_in_quanta(error))) + 1.0;
    return static_cast<std::int32_t>(std::min(quanta, 0x1p28));
}

/// Executes the collapses on a copy of the mesh and extends the influence boxes by each star.
class Sweep
{
public:
    Sweep(const QuantisedMesh& mesh, const Simplification& simplification,
          const Numbering& numbering, const FaceHistory& history)
        : mesh_(mesh)
        , simplification_(simplification)
        , numbering_(numbering)
        , history_(history)
        , corners_(mesh.faces)
        , boxes_(numbering.counts.records, kEmptyBox)
        , rings_(numbering.counts.records)
    {
    }

    Influence run()
    {
        for (const Collapse& collapse : simplification_.collapses)
        {
            const RecordId record = numbering_.record_of(collapse);
            note_ring(collapse, record);
            measure_star_after_split(collapse, record);
            collapse_fan(collapse);
            measure_fan_before_split(collapse, record);
            pass_on_to_dependencies(collapse, record);
        }
        return {chunk_boxes(), std::move(rings_)};
    }

private:
    /// Extends the box of a record by one state of one face.
    void include(RecordId record, std::uint32_t face, ErrorCode error)
    {
        const std::int32_t margin = margin_of(error);
        QuantumBox& box = boxes_[record.value];
        for (const std::uint32_t corner : corners_[face])
        {
            const GridPoint& point = mesh_.positions[corner];
            for (std::size_t axis = 0; axis < 3; ++axis)
            {
                box.low[axis] = std::min(box.low[axis], point[axis] - margin);
                box.high[axis] = std::max(box.high[axis], point[axis] + margin);
            }
        }
    }

    /// Stores the ring of the collapse: the vertices w0 .. wk, from the fan faces (v, wi, wi+1).
    void note_ring(const Collapse& collapse, RecordId record)
    {
        for (std::uint32_t i = 0; i < collapse.fan_size; ++i)
        {
            Corners corners = corners_[collapse.star[2 + i]];
            std::rotate(corners.begin(), std::ranges::find(corners, collapse.vertex),
                        corners.end());
            rings_[record.value].w[i] = numbering_.vertex_ids[corners[1]];
            rings_[record.value].w[i + 1] = numbering_.vertex_ids[corners[2]];
        }
    }

    void measure_star_after_split(const Collapse& collapse, RecordId record)
    {
        const StarHistory& star = history_.stars[record.value];
        for (std::uint32_t place = 0; place < 2 + collapse.fan_size; ++place)
        {
            if (collapse.star[place] != Collapse::kNoFace)
            {
                include(record, collapse.star[place], star.error_after[place]);
            }
        }
    }

    void collapse_fan(const Collapse& collapse)
    {
        for (std::uint32_t i = 0; i < collapse.fan_size; ++i)
        {
            Corners& corners = corners_[collapse.star[2 + i]];
            const auto at = std::find(corners.begin(), corners.end(), collapse.vertex);
            TACTUS_ASSERT(at != corners.end());
            *at = collapse.parent;
        }
    }

    void measure_fan_before_split(const Collapse& collapse, RecordId record)
    {
        const StarHistory& star = history_.stars[record.value];
        for (std::uint32_t i = 0; i < collapse.fan_size; ++i)
        {
            include(record, collapse.star[2 + i], star.error_before[i]);
        }
    }

    void pass_on_to_dependencies(const Collapse& collapse, RecordId record)
    {
        const StarHistory& star = history_.stars[record.value];
        for (std::uint32_t i = 0; i < collapse.fan_size; ++i)
        {
            if (!star.before[i].is_base())
            {
                join(boxes_[star.before[i].record().value], boxes_[record.value]);
            }
        }
    }

    [[nodiscard]] std::vector<QuantumBox> chunk_boxes() const
    {
        std::vector<QuantumBox> chunks(numbering_.counts.chunks(), kEmptyBox);
        for (std::uint32_t record = 0; record < boxes_.size(); ++record)
        {
            join(chunks[chunk_of({record}).value], boxes_[record]);
        }
        return chunks;
    }

    const QuantisedMesh& mesh_;
    const Simplification& simplification_;
    const Numbering& numbering_;
    const FaceHistory& history_;
    std::vector<Corners> corners_;
    std::vector<QuantumBox> boxes_;
    std::vector<StarRing> rings_;
};

} // namespace

Influence find_influence(const QuantisedMesh& mesh, const Simplification& simplification,
                         const Numbering& numbering, const FaceHistory& history)
{
    return Sweep(mesh, simplification, numbering, history).run();
}

void join(QuantumBox& box, const QuantumBox& other)
{
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        box.low[axis] = std::min(box.low[axis], other.low[axis]);
        box.high[axis] = std::max(box.high[axis], other.high[axis]);
    }
}

QuantumBox union_of(std::span<const QuantumBox> boxes)
{
    TACTUS_ASSERT(!boxes.empty());
    QuantumBox all = kEmptyBox;
    for (const QuantumBox& box : boxes)
    {
        join(all, box);
    }
    return all;
}

InfluenceBox relative_to(const QuantumBox& page, const QuantumBox& box)
{
    InfluenceBox relative;
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
        const std::int64_t step = index_step(page.low[axis], page.high[axis]);
        const std::int64_t origin = page.low[axis];
        relative.low[axis] = static_cast<std::uint16_t>((box.low[axis] - origin) / step);
        relative.high[axis] =
            static_cast<std::uint16_t>((box.high[axis] - origin + step - 1) / step);
    }
    return relative;
}

} // namespace tactus
