// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/encode/face_history.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/spm/chunk_grammar.hpp"

#include <algorithm>
#include <cmath>

namespace tactus
{

namespace
{

constexpr std::uint32_t kNever = 0xFFFF'FFFFU;

/// Index of the first collapse that changes or removes each face; before that collapse, the face is
/// original.
std::vector<std::uint32_t> find_first_changes(std::size_t faces,
                                              const std::vector<Collapse>& collapses)
{
    std::vector<std::uint32_t> first(faces, kNever);
    for (std::uint32_t i = 0; i < collapses.size(); ++i)
    {
        const Collapse& collapse = collapses[i];
        for (std::uint32_t place = 0; place < 2 + collapse.fan_size; ++place)
        {
            const std::uint32_t face = collapse.star[place];
            if (face != Collapse::kNoFace && first[face] == kNever)
            {
                first[face] = i;
            }
        }
    }
    return first;
}

ErrorCode code_of(bool original, float quanta)
{
    TACTUS_ASSERT(std::isfinite(quanta) && quanta >= 0.0F);
    return original ? ErrorCode{0} : encode_error(static_cast<double>(quanta));
}

/// State and bound of a face at one moment of the reverse replay.
struct FaceNow
{
    FaceState state;
    ErrorCode error{0};
};

class Tracer
{
public:
    Tracer(const QuantisedMesh& mesh, const Simplification& simplification,
           const Numbering& numbering)
        : simplification_(simplification)
        , numbering_(numbering)
        , first_change_(find_first_changes(mesh.faces.size(), simplification.collapses))
        , now_(mesh.faces.size())
    {
        history_.stars.resize(numbering.counts.records);
        history_.base_error.resize(numbering.counts.base_faces);
    }

    FaceHistory trace()
    {
        start_from_base();
        for (std::size_t i = simplification_.collapses.size(); i-- > 0;)
        {
            undo(static_cast<std::uint32_t>(i));
        }
        return std::move(history_);
    }

private:
    void start_from_base()
    {
        for (std::uint32_t id = 0; id < numbering_.counts.base_faces; ++id)
        {
            const std::uint32_t at = numbering_.base_faces[id];
            const std::uint32_t face = simplification_.base_faces[at];
            const ErrorCode error =
                code_of(first_change_[face] == kNever, simplification_.base_error[at]);
            now_[face] = {FaceState::base(), error};
            history_.base_error[id] = error;
            history_.max_error = std::max(history_.max_error, error);
        }
    }

    void undo(std::uint32_t index)
    {
        const Collapse& collapse = simplification_.collapses[index];
        const RecordId record = numbering_.record_of(collapse);
        StarHistory& star = history_.stars[record.value];
        note_before(collapse, star);
        for (std::uint32_t place = 0; place < 2 + collapse.fan_size; ++place)
        {
            const std::uint32_t face = collapse.star[place];
            if (face == Collapse::kNoFace)
            {
                continue;
            }
            star.error_after[place] = code_of(first_change_[face] == index, collapse.error[place]);
        }
        const ErrorCode largest = *std::ranges::max_element(star.error_after);
        history_.max_error = std::max(history_.max_error, largest);
        for (std::uint32_t place = 0; place < 2 + collapse.fan_size; ++place)
        {
            ErrorCode& error = star.error_after[place];
            error = rounded_error(error, largest);
            if (collapse.star[place] != Collapse::kNoFace)
            {
                now_[collapse.star[place]] = {FaceState::after(record, place), error};
            }
        }
    }

    void note_before(const Collapse& collapse, StarHistory& star)
    {
        std::uint32_t depth = 0;
        for (std::uint32_t i = 0; i < collapse.fan_size; ++i)
        {
            const FaceNow& now = now_[collapse.star[2 + i]];
            star.before[i] = now.state;
            star.error_before[i] = now.error;
            if (!now.state.is_base())
            {
                depth = std::max(depth, history_.stars[now.state.record().value].depth);
            }
        }
        star.depth = depth + 1;
        history_.max_depth = std::max(history_.max_depth, star.depth);
    }

    const Simplification& simplification_;
    const Numbering& numbering_;
    std::vector<std::uint32_t> first_change_;
    std::vector<FaceNow> now_;
    FaceHistory history_;
};

} // namespace

FaceHistory trace_faces(const QuantisedMesh& mesh, const Simplification& simplification,
                        const Numbering& numbering)
{
    return Tracer(mesh, simplification, numbering).trace();
}

} // namespace tactus
