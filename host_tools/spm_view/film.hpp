// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "host_tools/spm_view/live_state.hpp"
#include "host_tools/spm_view/model_shelf.hpp"
#include "platform/recording/recording.hpp"
#include "rt_core/records/frame_output.hpp"
#include "transport/base/refusal.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace tactus::view
{

/// A value as a function of the frame, stored as its changes.
template <typename T, typename Equal = std::equal_to<T>>
class Timeline
{
public:
    /// Sets the value from `frame` on. Frames must not decrease from call to call.
    void set(std::uint64_t frame, const T& value)
    {
        if (steps_.empty() || !Equal{}(steps_.back().second, value))
        {
            steps_.emplace_back(frame, value);
        }
    }
    /// Value at a frame; null before the first set().
    [[nodiscard]] const T* at(std::uint64_t frame) const
    {
        const auto next =
            std::ranges::upper_bound(steps_, frame, {}, &std::pair<std::uint64_t, T>::first);
        return next == steps_.begin() ? nullptr : &std::prev(next)->second;
    }

private:
    std::vector<std::pair<std::uint64_t, T>> steps_;
};

/// A recording prepared for display: for each frame the data that a viewer would have received, for
/// access in any order. Takes about 400 bytes a frame with one tool, plus the changes. One thread
/// creates a film, any thread may read it.
class Film
{
public:
    /// Replays the recording at `path` and adds its models to the shelf. If `goes_on` returns
    /// false, the film ends with the frames so far. `number`, unlike for each film, becomes part of
    /// its id(). Refused if the file is unreadable, cannot be replayed or has no frame.
    [[nodiscard]] static Result<std::unique_ptr<Film>, Refusal>
    develop(const std::string& path, std::uint8_t number, ModelShelf& shelf,
            const std::function<bool()>& goes_on);

    /// State of the controller in a frame; for numbers beyond the end, in the last frame. The
    /// serial of its refinement state is the number of the frame.
    [[nodiscard]] LiveController at(std::uint64_t frame) const;
    [[nodiscard]] StatePointer state(std::uint64_t frame) const;

    [[nodiscard]] const dds::ControllerId& id() const noexcept { return id_; }
    [[nodiscard]] const std::string& name() const noexcept { return name_; }
    [[nodiscard]] std::int64_t period_ns() const noexcept { return period_ns_; }
    [[nodiscard]] std::uint64_t frames() const noexcept { return moments_.size(); }
    /// Reason why the film ends before the recording; empty if it does not.
    [[nodiscard]] const std::string& note() const noexcept { return note_; }

    /// Difference of two films in a frame.
    struct Gap
    {
        bool differs{false};
        double amount{0.0}; ///< Size of the difference, in metres, in newtons or as a count.
    };
    /// Kinds of difference. Each is a possible cause of those after it.
    enum class What : std::uint8_t
    {
        hand,    ///< Poses of devices.
        scene,   ///< Objects added, moved or removed.
        pieces,  ///< Pieces received from servers.
        faces,   ///< Active faces.
        answers, ///< Bounds and kinds of the distances.
        forces,  ///< Forces sent.
    };
    static constexpr std::size_t kWhats = 6;
    /// Difference of kind `what` between two films in a frame that both must have.
    [[nodiscard]] static Gap compare(const Film& a, const Film& b, std::uint64_t frame, What what);

private:
    /// Data of one frame; `tools_`, `pairs_` and `regions_` have the rest.
    struct Moment
    {
        std::int64_t time_ns{0};
        std::uint64_t scene{0};  ///< Hash of the frame's changes of the scene.
        std::uint64_t pieces{0}; ///< Hash of the pieces that arrived in the frame.
        std::uint64_t faces{0};  ///< Hash of the models' state hashes.
        /// Number of frames so far with each worst answer, by AnswerKind.
        std::array<std::uint32_t, kAnswerKinds> answers{};
        std::uint32_t faults{0};
        std::uint32_t faults_seen{0};
        std::uint32_t pairs_end{0};
        std::uint32_t regions_end{0};
        AnswerKind kind{AnswerKind::separated};
    };
    /// Bits of a page's split records; none while the page is not resident.
    using Page = std::optional<std::uint64_t>;
    using PageName = std::pair<std::uint32_t, std::uint32_t>; ///< Numbers of model and chunk.
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
    std::vector<Vec3> origins_m_;             ///< Origins of the models' frames, by model.
    std::vector<Moment> moments_;             ///< Moments, one for each frame.
    std::vector<ToolTelemetry> tools_;        ///< Tools, tool_count_ for each frame.
    std::vector<PairTelemetry> pairs_; ///< Pairs of all frames; those of a frame end at pairs_end.
    std::vector<RefinementStateRegion>
        regions_; ///< Regions; those of a moment end at its regions_end.
    Timeline<Budgets, SameBudgets> budgets_;
    std::vector<Timeline<ModelTelemetry>> model_states_; ///< States by model.
    std::map<PageName, Timeline<Page>> pages_;
    std::map<std::uint32_t, Timeline<std::optional<ObjectTelemetry>>>
        objects_; ///< Objects by number.
};

/// First and largest difference of two films in one kind.
struct FilmDifference
{
    std::string what;       ///< Name of the kind.
    std::string how;        ///< First and largest amount, as text.
    std::uint64_t frame{0}; ///< First frame with a difference.
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
    /// Differences in the order of Film::What, then that of the lengths; empty for one film.
    [[nodiscard]] const std::vector<FilmDifference>& differences() const noexcept
    {
        return differences_;
    }
    /// State of all films in one frame, as Film::at().
    [[nodiscard]] Snapshot at(std::uint64_t frame) const;
    /// Refinement state of a film, by its id_text(), in a frame; null if there is no such film or
    /// frame.
    [[nodiscard]] StatePointer state(const std::string& controller, std::uint64_t frame) const;

private:
    std::vector<std::unique_ptr<Film>> films_;
    std::vector<FilmDifference> differences_;
};

} // namespace tactus::view
