// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/spm_view/live_state.hpp"
#include "host_tools/spm_view/model_shelf.hpp"
#include "host_tools/spm_view/timeline.hpp"
#include "platform/recording/recording.hpp"
#include "rt_core/records/frame_output.hpp"
#include "transport/base/refusal.hpp"

#include <cstdint>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace tactus::view
{

/// A recording prepared for a viewer: the data that a viewer would have received in each frame, so
/// that any frame can be shown at once. Some 400 bytes a frame with one tool, and the changes. One
/// thread creates it, any thread reads it.
class Film
{
public:
    /// Replays the recording, which takes the time of its frames, and puts its models on the shelf.
    /// Ends early, with the frames so far, if `goes_on` returns false. `number` distinguishes
    /// films. Refused if the file is, if no frame can be created from it or it has none.
    [[nodiscard]] static Result<std::unique_ptr<Film>, Refusal>
    develop(const std::string& path, std::uint8_t number, ModelShelf& shelf,
            const std::function<bool()>& goes_on);

    /// State of the controller in one frame, the last one for numbers beyond: its telemetry, its
    /// refinement state with the frame's number as serial, and its objects.
    [[nodiscard]] LiveController at(std::uint64_t frame) const;
    [[nodiscard]] FrontPointer front(std::uint64_t frame) const;

    [[nodiscard]] const dds::ControllerId& id() const noexcept { return id_; }
    [[nodiscard]] const std::string& name() const noexcept { return name_; }
    [[nodiscard]] std::int64_t period_ns() const noexcept { return period_ns_; }
    [[nodiscard]] std::uint64_t frames() const noexcept { return moments_.size(); }
    /// Reason why the film ends before the recording does; otherwise empty.
    [[nodiscard]] const std::string& note() const noexcept { return note_; }

    /// Difference of two films in a frame.
    struct Gap
    {
        bool differs{false};
        double amount{0.0}; ///< Amount, in metres, newtons or a count.
    };
    /// Kinds of difference, in the order of cause and effect.
    enum class What : std::uint8_t
    {
        hand,    ///< Poses of devices.
        scene,   ///< Objects added, moved or removed.
        pieces,  ///< Pieces received from servers.
        faces,   ///< Active faces.
        answers, ///< Distances: their bounds and kinds.
        forces,  ///< Forces sent.
    };
    static constexpr std::size_t kWhats = 6;
    /// Compares a frame, which both films must have.
    [[nodiscard]] static Gap compare(const Film& a, const Film& b, std::uint64_t frame, What what);

private:
    /// Data of one frame; tools and pairs are in separate vectors.
    struct Moment
    {
        std::int64_t time_ns{0};
        std::uint64_t scene{0};  ///< Hash of the frame's changes of the scene.
        std::uint64_t pieces{0}; ///< Hash of the frame's arrivals.
        std::uint64_t faces{0};  ///< Hash of the models' state hashes.
        /// Number of frames so far by the worst answer's kind.
        std::array<std::uint32_t, 5> answers{};
        std::uint32_t faults{0};
        std::uint32_t faults_seen{0};
        std::uint32_t pairs_end{0};
        std::uint32_t regions_end{0};
        AnswerKind kind{AnswerKind::separated};
    };
    /// Split records of a page; none while it is not resident.
    using Page = std::optional<std::uint64_t>;
    using PageName = std::pair<std::uint32_t, std::uint32_t>; ///< Model and chunk.
    struct Maker;
    struct SameBudgets
    {
        bool operator()(const Budgets& a, const Budgets& b) const noexcept
        {
            static_assert(std::has_unique_object_representations_v<Budgets>);
            return std::memcmp(&a, &b, sizeof(Budgets)) == 0;
        }
    };

    Film() = default;

    [[nodiscard]] std::span<const ToolTelemetry> tools(std::uint64_t frame) const;
    [[nodiscard]] std::span<const PairTelemetry> pairs(std::uint64_t frame) const;
    [[nodiscard]] std::span<const RefinementStateRegion> regions(std::uint64_t frame) const;
    void add_models(std::uint64_t frame, LiveController& controller) const;

    dds::ControllerId id_{};
    std::string name_;
    std::string note_;
    std::int64_t period_ns_{1};
    std::size_t tool_count_{0};
    std::vector<RefinementStateTool> shapes_; ///< Shapes by tool.
    std::vector<ModelIdentity> models_;       ///< Identities by model.
    std::vector<Moment> moments_;             ///< Moments by frame.
    std::vector<ToolTelemetry> tools_;        ///< Tools by frame, tool_count_ each.
    std::vector<PairTelemetry> pairs_;        ///< Pairs; those of a moment end at its pairs_end.
    std::vector<RefinementStateRegion>
        regions_; ///< Regions; those of a moment end at its regions_end.
    Timeline<Budgets, SameBudgets> budgets_;
    std::vector<Timeline<ModelTelemetry>> model_states_; ///< States by model.
    std::map<PageName, Timeline<Page>> pages_;
    std::map<std::uint32_t, Timeline<std::optional<SeenObject>>> objects_; ///< Objects by number.
};

/// Difference of two films in one kind.
struct FilmDifference
{
    std::string what;       ///< Kind of the difference, as text.
    std::string how;        ///< First amount and maximum, as text.
    std::uint64_t frame{0}; ///< First frame.
};

/// One recording, or two for comparison.
class Films
{
public:
    explicit Films(std::vector<std::unique_ptr<Film>> films);

    [[nodiscard]] const std::vector<std::unique_ptr<Film>>& films() const noexcept
    {
        return films_;
    }
    /// Number of frames of the longest film.
    [[nodiscard]] std::uint64_t frames() const noexcept;
    /// First differences, in the order of Film::What, and that of the length; none for one film.
    [[nodiscard]] const std::vector<FilmDifference>& differences() const noexcept
    {
        return differences_;
    }
    /// All films in one frame; serial and refinement states as in Film::at().
    [[nodiscard]] Snapshot at(std::uint64_t frame) const;
    /// Null if there is no such film or frame.
    [[nodiscard]] FrontPointer front(const std::string& controller, std::uint64_t frame) const;

private:
    std::vector<std::unique_ptr<Film>> films_;
    std::vector<FilmDifference> differences_;
};

} // namespace tactus::view
