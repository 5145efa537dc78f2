// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/pose_door.hpp"
#include "platform/machine/time.hpp"
#include "platform/scene/scene_choice.hpp"
#include "platform/scene/scene_parts.hpp"
#include "transport/dds/authority.hpp"
#include "transport/dds/scene_reader.hpp"
#include "transport/log.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tactus::hrtc
{

/// What has become of a scene's objects since the start.
struct SceneNewsCounts
{
    std::uint64_t came{0};            ///< Objects that the frame was told of,
    std::uint64_t went{0};            ///< and that left it.
    std::uint64_t feels{0};           ///< Other materials that it was told of.
    std::uint64_t limited{0};         ///< Materials that are felt otherwise than their server says.
    std::uint64_t passed_over{0};     ///< That can't be touched: no such model, or no room.
    std::uint64_t motion_regained{0}; ///< See dds::SceneReader.
};

/// Keeps our objects where the hosts have theirs. Transport thread.
///
/// With a scene ours are all objects of the host whose word counts for it: they come, move and go
/// as it says. When it is gone they stay and grow stale; where another takes its place, they go and
/// its objects come.
///
/// Without one, the first object of ours that shows a model moves like an object of the host whose
/// word counts for the model: the one with the least number of those with that model.
class SceneKeeper
{
public:
    /// `reader` has followed the scene's host, if there is a scene. `authorities` are the scene's,
    /// or one a model; they are stepped elsewhere. They and the parts must outlive it. `log`
    /// gets a line for what can't be touched, and one for each object that is felt otherwise than
    /// its server says.
    SceneKeeper(std::span<const dds::Authority> authorities,
                std::unique_ptr<dds::SceneReader> reader, SceneParts parts, ShownScene scene,
                Log log);

    /// Gets an object's number, its generation and its name when it comes.
    using NameSink = std::function<void(std::uint32_t, std::uint32_t, const std::string&)>;

    /// Where it puts what it learns; both live as long as the run, and `names` may be empty. First
    /// of all.
    void connect(PoseDoor& door, MonotonicTime now, NameSink names = {});
    /// Never waits.
    void step(MonotonicTime now);

    /// Whose pose our object has; nothing where no host shows it.
    [[nodiscard]] std::optional<HostObject> shown_as(std::uint32_t object) const;
    /// Of all objects of ours that show the model.
    [[nodiscard]] const dds::PoseCounts& counts(std::size_t model) const { return counts_[model]; }
    /// When a host that shows the model was heard last; 0: never.
    [[nodiscard]] MonotonicTime heard(std::size_t model) const { return heard_[model]; }
    [[nodiscard]] SceneNewsCounts news() const noexcept
    {
        SceneNewsCounts counts = news_;
        counts.motion_regained = reader_->motion_regained();
        return counts;
    }

private:
    /// An object of a host, and which of those under its number.
    using Generation = std::pair<HostObject, std::uint32_t>;

    /// One object of ours.
    struct Slot
    {
        std::optional<HostObject> bound;
        std::string name; ///< Empty unless the object came later.
        ObjectSpec spec;
        ObjectPose pose;       ///< The newest.
        dds::PoseCounts known; ///< What is in `counts_` of the host's object.
        bool is_here{false};   ///< It is to be in the frame's scene,
        bool is_told{false};   ///< and is, or will be with what waits at the door.
        bool owes_feel{false}; ///< That it has another material the frame wasn't told.
        std::uint32_t generation{0};
    };

    void follow_scene_host();
    void follow_model_hosts(MonotonicTime now);
    void take_news(dds::SceneNews news, const dds::SeenObject& object, MonotonicTime now);
    void find_first(std::size_t model, MonotonicTime now);
    void offer(const dds::SeenObject& object, MonotonicTime now);
    void offer_left_out(MonotonicTime now);
    void bind(std::uint32_t place, const dds::SeenObject& object, MonotonicTime now);
    void unbind(std::uint32_t place);
    void move(std::uint32_t place, const dds::SeenObject& object, MonotonicTime now);
    void feel(std::uint32_t place, const ShownObject& shown);
    [[nodiscard]] Material felt(const HostObject& object, const ShownObject& shown);
    void leave(std::uint32_t place);
    void pass_on(MonotonicTime now);
    void hear(MonotonicTime now);
    [[nodiscard]] ObjectPose pose_of(std::size_t model, const dds::SeenObject& object) const;
    [[nodiscard]] std::optional<std::size_t> model_of(const ContentHash& hash) const;

    std::span<const dds::Authority> authorities_;
    std::unique_ptr<dds::SceneReader> reader_;
    SceneParts parts_;
    std::string scene_;
    SceneMaterials materials_;
    RateLimitedLog log_;
    std::vector<ModelHeader> headers_; ///< Views into the parts' models.
    PoseDoor* door_{nullptr};
    NameSink names_;
    std::vector<std::uint64_t> hosts_;       ///< That are followed.
    std::vector<std::uint64_t> model_hosts_; ///< Without a scene: of each model, or 0.
    std::vector<std::uint32_t> first_;       ///< Without a scene: the object of each model.
    std::vector<Slot> slots_;
    std::map<HostObject, std::uint32_t> places_; ///< Of what is bound.
    std::set<std::uint32_t> free_;               ///< Places of no object.
    std::set<Generation> passed_over_;           ///< Nobody can touch them,
    std::set<Generation> left_out_;              ///< or there is no room for them.
    std::set<HostObject> limited_;               ///< A line has told of their materials.
    std::deque<std::uint32_t> untold_; ///< Where is_here and is_told differ, or a feel is owed.
    std::vector<dds::PoseCounts> counts_;
    std::vector<MonotonicTime> heard_;
    SceneNewsCounts news_;
};

} // namespace tactus::hrtc
