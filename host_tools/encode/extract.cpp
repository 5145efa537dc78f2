// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.

/// A cut is a set of split records that contains the dependencies of each. Only one record ends
/// each face state. The demand "this state must not be active" therefore means "if this state is
/// reached, split that record", which has the form of a dependency. Following the demands from
/// their start gives the smallest set that meets them all.

#include "host_tools/encode/extract.hpp"

#include "host_tools/encode/replay.hpp"
#include "rt_core/base/assert.hpp"

#include <algorithm>
#include <vector>

namespace tactus
{

namespace
{

/// Margin of the zone: far above rounding, far below any detail.
constexpr double kZoneMargin_quanta = 1e-3;

double bound_m(const DecodedModel& model, ErrorCode error)
{
    return static_cast<double>(error_in_quanta(error)) *
           static_cast<double>(model.header().quantum_m());
}

std::uint32_t faces_added_by(const VsplitRecord& record)
{
    return (record.has_face(0) ? 1U : 0U) + (record.has_face(1) ? 1U : 0U);
}

/// Table of the record that ends each face state, that is, changes the face next.
class NextRecords
{
public:
    explicit NextRecords(const DecodedModel& model)
        : base_faces_(model.header().counts().base_faces)
        , next_(base_faces_ + kPlaces * std::size_t{model.header().counts().records})
    {
        for (std::uint32_t id = 0; id < model.header().counts().records; ++id)
        {
            const VsplitRecord& record = model.record({id});
            for (std::uint32_t i = 0; i < record.fan_size; ++i)
            {
                next_[place_of(record.star[2 + i], record.before[i])] = {id};
            }
        }
    }

    /// Record that ends the state; none for a final state.
    [[nodiscard]] RecordId after(FaceId face, FaceState state) const
    {
        return next_[place_of(face, state)];
    }

private:
    /// Number of places in a star: FaceState has three bits for them.
    static constexpr std::size_t kPlaces = 8;
    static_assert(kMaxStarFaces <= kPlaces);

    [[nodiscard]] std::size_t place_of(FaceId face, FaceState state) const
    {
        return state.is_base() ? face.value
                               : base_faces_ + kPlaces * state.record().value + state.place();
    }

    std::size_t base_faces_;
    std::vector<RecordId> next_;
};

/// Set of the records to be split, always with their dependencies.
class Cut
{
public:
    /// Starts with the smallest cut without an active face state of a bound above `limit_m`; each
    /// require() keeps this property. None: no limit.
    Cut(const DecodedModel& model, std::optional<double> limit_m)
        : model_(model)
        , is_split_(model.header().counts().records)
        , face_count_(model.header().counts().base_faces)
    {
        if (limit_m)
        {
            limit_error(*limit_m);
        }
    }

    [[nodiscard]] bool has(RecordId id) const { return is_split_[id.value]; }
    [[nodiscard]] std::uint32_t face_count() const { return face_count_; }

    void require(RecordId id)
    {
        open_.push_back(id);
        follow_demands();
    }

    [[nodiscard]] Replay replayed() const
    {
        Replay replay(model_);
        for (const RecordId id : in_dependency_order(model_))
        {
            if (has(id))
            {
                const auto fault = replay.split(id);
                TACTUS_ASSERT(!fault);
            }
        }
        return replay;
    }

private:
    void limit_error(double error_m)
    {
        next_.emplace(model_);
        limit_m_ = error_m;
        for (std::uint32_t face = 0; face < model_.header().counts().base_faces; ++face)
        {
            leave_if_coarse({face}, FaceState::base());
        }
        follow_demands();
    }

    void follow_demands()
    {
        while (!open_.empty())
        {
            const RecordId id = open_.back();
            open_.pop_back();
            if (!has(id))
            {
                take(id);
            }
        }
    }

    void take(RecordId id)
    {
        const VsplitRecord& record = model_.record(id);
        is_split_[id.value] = true;
        face_count_ += faces_added_by(record);
        for (std::uint32_t i = 0; i < record.fan_size; ++i)
        {
            if (!record.before[i].is_base())
            {
                open_.push_back(record.before[i].record());
            }
        }
        for (std::uint32_t place = 0; next_ && place < record.star_end(); ++place)
        {
            if (!record.star[place].is_none())
            {
                leave_if_coarse(record.star[place], FaceState::after(id, place));
            }
        }
    }

    void leave_if_coarse(FaceId face, FaceState state)
    {
        if (bound_m(model_, model_.error_of(face, state)) > limit_m_)
        {
            const RecordId next = next_->after(face, state);
            TACTUS_ASSERT(!next.is_none()); // Only exact states are final.
            open_.push_back(next);
        }
    }

    const DecodedModel& model_;
    std::vector<bool> is_split_;
    std::uint32_t face_count_;
    std::vector<RecordId> open_;
    std::optional<NextRecords> next_; ///< Present only with a limit.
    double limit_m_{0.0};
};

Triangle triangle_of(const DecodedModel& model, const std::array<VertexId, 3>& corners)
{
    return {to_vec3(model.position_m(corners[0])), to_vec3(model.position_m(corners[1])),
            to_vec3(model.position_m(corners[2]))};
}

/// Requires the last record of every source face that touches the zone; returns the number of these
/// faces.
std::uint32_t require_zone(const DecodedModel& model, const Zone& zone, Cut& cut)
{
    Replay source(model);
    for (const RecordId id : in_dependency_order(model))
    {
        const auto fault = source.split(id);
        TACTUS_ASSERT(!fault);
    }
    const HeaderFields& fields = model.header().fields();
    const Vec3 origin_m(fields.origin_m[0], fields.origin_m[1], fields.origin_m[2]);
    const double margin_m = kZoneMargin_quanta * static_cast<double>(model.header().quantum_m());
    const Zone here = moved_and_grown(zone, origin_m, margin_m);
    std::uint32_t touched = 0;
    for (std::uint32_t i = 0; i < model.header().counts().face_ids(); ++i)
    {
        const FaceId face{i};
        if (!source.is_active(face) || !touches(here, triangle_of(model, source.corners(face))))
        {
            continue;
        }
        ++touched;
        if (!source.state(face).is_base())
        {
            cut.require(source.state(face).record());
        }
    }
    return touched;
}

void fill_up(const DecodedModel& model, std::uint32_t faces, Cut& cut)
{
    for (const RecordId id : coarsest_first(model))
    {
        if (cut.has(id))
        {
            continue;
        }
        if (std::uint64_t{cut.face_count()} + faces_added_by(model.record(id)) > faces)
        {
            break;
        }
        cut.require(id);
    }
}

double largest_bound_m(const DecodedModel& model, const Replay& replay)
{
    ErrorCode largest = 0;
    for (std::uint32_t i = 0; i < model.header().counts().face_ids(); ++i)
    {
        if (replay.is_active({i}))
        {
            largest = std::max(largest, model.error_of({i}, replay.state({i})));
        }
    }
    return bound_m(model, largest);
}

} // namespace

Extraction extract(const DecodedModel& model, const ExtractRequest& request)
{
    Extraction extraction;
    Cut cut(model, request.error_m);
    if (request.zone)
    {
        extraction.zone_faces = require_zone(model, *request.zone, cut);
    }
    if (request.faces)
    {
        fill_up(model, *request.faces, cut);
    }
    const Replay replay = cut.replayed();
    extraction.mesh = replay.mesh();
    extraction.error_max_m = largest_bound_m(model, replay);
    return extraction;
}

} // namespace tactus
