// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/scene_mailbox.hpp"
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

/// Counts of a scene's changes since the start.
struct SceneNewsCounts
{
    std::uint64_t came{0};            ///< Objects added to the frame.
    std::uint64_t went{0};            ///< Objects removed from the frame.
    std::uint64_t feels{0};           ///< Materials changed in the frame.
    std::uint64_t limited{0};         ///< Materials limited to less than their server's.
    std::uint64_t passed_over{0};     ///< Objects that can't be touched: no such model, or no room.
    std::uint64_t motion_regained{0}; ///< See dds::SceneReader.
};

/// Keeps the controller's objects at the poses of the hosts. Transport thread.
///
/// A scene has all objects of its authoritative host: they are added, moved and removed with it. If
/// the host is gone, they stay and become stale; if another host replaces it, they are removed and
/// its objects added.
///
/// Without a scene, the first object that shows a model follows one object of the model's
/// authoritative host: the one with the least number of those with that model.
class SceneKeeper
{
public:
    /// `reader` has followed the scene's host, if there is a scene. `authorities`: the scene's, or
    /// one a model; stepped by the caller. They and the parts must outlive it. `log` gets a line
    /// for each object that can't be touched, and for each material that is limited.
    SceneKeeper(std::span<const dds::Authority> authorities,
                std::unique_ptr<dds::SceneReader> reader, SceneParts parts, ShownScene scene,
                Log log);

    /// Sink of an object's number, its generation and its name when it is added.
    using NameSink = std::function<void(std::uint32_t, std::uint32_t, const std::string&)>;

    /// Connects the output; call it first. Both live as long as the run, and `names` may be empty.
    void connect(SceneMailbox& mailbox, MonotonicTime now, NameSink names = {});
    /// Never waits.
    void step(MonotonicTime now);

    /// Host object whose pose our object has; none if no host shows it.
    [[nodiscard]] std::optional<HostObject> shown_as(std::uint32_t object) const;
    /// Pose counts of all our objects that show the model.
    [[nodiscard]] const dds::PoseCounts& counts(std::size_t model) const { return counts_[model]; }
    /// Time when a host that shows the model was last heard; 0: never.
    [[nodiscard]] MonotonicTime heard(std::size_t model) const { return heard_[model]; }
    [[nodiscard]] SceneNewsCounts news() const noexcept
    {
        SceneNewsCounts counts = news_;
        counts.motion_regained = reader_->motion_regained();
        return counts;
    }

private:
    /// An object of a host, and the generation under its number.
    using Generation = std::pair<HostObject, std::uint32_t>;

    /// One object of the controller.
    struct Slot
    {
        std::optional<HostObject> bound;
        std::string name; ///< Name; empty unless the object was added later.
        ObjectSpec spec;
        ObjectPose pose;         ///< Newest pose.
        dds::PoseCounts known;   ///< Part in `counts_` of the host's object.
        bool is_resident{false}; ///< True if it should be in the frame's scene.
        bool is_told{false};     ///< True if the frame knows it, or the change is queued.
        bool owes_feel{false};   ///< True if a change of its material is still to be queued.
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
    std::vector<ModelHeader> headers_; ///< Headers of the parts' models, as views.
    SceneMailbox* mailbox_{nullptr};
    NameSink names_;
    std::vector<std::uint64_t> hosts_;       ///< Hosts that are followed.
    std::vector<std::uint64_t> model_hosts_; ///< Host of each model without a scene, or 0.
    std::vector<std::uint32_t> first_;       ///< Object of each model without a scene.
    std::vector<Slot> slots_;
    std::map<HostObject, std::uint32_t> places_; ///< Places of bound objects.
    std::set<std::uint32_t> free_;               ///< Places without an object.
    std::set<Generation> passed_over_;           ///< Objects that can't be touched.
    std::set<Generation> left_out_;              ///< Objects beyond the capacity.
    std::set<HostObject> limited_;               ///< Objects with a line on their limited material.
    /// Places where is_resident and is_told differ, or a material is owed.
    std::deque<std::uint32_t> untold_;
    std::vector<dds::PoseCounts> counts_;
    std::vector<MonotonicTime> heard_;
    SceneNewsCounts news_;
};

} // namespace tactus::hrtc
