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

/// A recording that was run through once: of every frame what a viewer would have heard of it, so
/// that any frame can be shown at once. Some 400 bytes a frame of one tool, and what changes. One
/// thread makes it, any reads it.
class Film
{
public:
    /// Replays the recording, which takes the time of its frames, and puts its models on the shelf;
    /// ends early, with what there is by then, when `goes_on` returns false. `number` tells films
    /// apart. Refused when the file is, or no frame can be made of it or it has none.
    [[nodiscard]] static Result<std::unique_ptr<Film>, Refusal>
    develop(const std::string& path, std::uint8_t number, ModelShelf& shelf,
            const std::function<bool()>& goes_on);

    /// The controller in one frame, the last one for numbers beyond: what it told, its front with
    /// the frame's number as serial, and its objects.
    [[nodiscard]] LiveController at(std::uint64_t frame) const;
    [[nodiscard]] FrontPointer front(std::uint64_t frame) const;

    [[nodiscard]] const dds::ControllerId& id() const noexcept { return id_; }
    [[nodiscard]] const std::string& name() const noexcept { return name_; }
    [[nodiscard]] std::int64_t period_ns() const noexcept { return period_ns_; }
    [[nodiscard]] std::uint64_t frames() const noexcept { return moments_.size(); }
    /// Why it ends where it ends, where that is not the recording's end; else empty.
    [[nodiscard]] const std::string& note() const noexcept { return note_; }

    /// What differs in a frame of two films, and by how much.
    struct Gap
    {
        bool differs{false};
        double amount{0.0}; ///< In metres, newtons or as many.
    };
    /// In the order in which one follows from the other.
    enum class What : std::uint8_t
    {
        hand,    ///< Where devices are.
        scene,   ///< Objects that come, move or go.
        pieces,  ///< What came from hosts.
        faces,   ///< Which are active.
        answers, ///< Distances: brackets and their kinds.
        forces,  ///< That went out.
    };
    static constexpr std::size_t kWhats = 6;
    /// Both have the frame.
    [[nodiscard]] static Gap compare(const Film& a, const Film& b, std::uint64_t frame, What what);

private:
    /// Of one frame; tools and pairs follow one another in vectors of their own.
    struct Moment
    {
        std::int64_t time_ns{0};
        std::uint64_t scene{0};                 ///< Hash of the frame's changes,
        std::uint64_t pieces{0};                ///< of what came,
        std::uint64_t faces{0};                 ///< and of the models' state hashes.
        std::array<std::uint32_t, 5> answers{}; ///< Frames so far, by the worst answer's kind.
        std::uint32_t faults{0};
        std::uint32_t faults_seen{0};
        std::uint32_t pairs_end{0};
        std::uint32_t regions_end{0};
        AnswerKind kind{AnswerKind::decided};
    };
    /// A page's split records; none while it isn't here.
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
    [[nodiscard]] std::span<const FrontRegion> regions(std::uint64_t frame) const;
    void add_models(std::uint64_t frame, LiveController& controller) const;

    dds::ControllerId id_{};
    std::string name_;
    std::string note_;
    std::int64_t period_ns_{1};
    std::size_t tool_count_{0};
    std::vector<FrontTool> shapes_;     ///< One a tool.
    std::vector<ModelIdentity> models_; ///< One a model.
    std::vector<Moment> moments_;       ///< One a frame.
    std::vector<ToolTelemetry> tools_;  ///< tool_count_ a frame.
    std::vector<PairTelemetry> pairs_;  ///< Up to a moment's pairs_end.
    std::vector<FrontRegion> regions_;  ///< Up to a moment's regions_end.
    Timeline<Budgets, SameBudgets> budgets_;
    std::vector<Timeline<ModelTelemetry>> model_states_; ///< One a model.
    std::map<PageName, Timeline<Page>> pages_;
    std::map<std::uint32_t, Timeline<std::optional<SeenObject>>> objects_; ///< By number.
};

/// What two films have of one kind that differs.
struct FilmDifference
{
    std::string what;       ///< In words.
    std::string how;        ///< Likewise: how much at first, and at most.
    std::uint64_t frame{0}; ///< The first one.
};

/// One recording, or two to be compared.
class Films
{
public:
    explicit Films(std::vector<std::unique_ptr<Film>> films);

    [[nodiscard]] const std::vector<std::unique_ptr<Film>>& films() const noexcept
    {
        return films_;
    }
    /// Of the longest.
    [[nodiscard]] std::uint64_t frames() const noexcept;
    /// What first differs, in the order of Film::What, and the length; none of one film.
    [[nodiscard]] const std::vector<FilmDifference>& differences() const noexcept
    {
        return differences_;
    }
    /// All of them in one frame; serial and fronts as Film::at() has them.
    [[nodiscard]] Snapshot at(std::uint64_t frame) const;
    /// Null where there is no such film or frame.
    [[nodiscard]] FrontPointer front(const std::string& controller, std::uint64_t frame) const;

private:
    std::vector<std::unique_ptr<Film>> films_;
    std::vector<FilmDifference> differences_;
};

} // namespace tactus::view
