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

/// Passes the objects' poses, and a scene's changes, from servers to the frame's mailbox. Transport
/// thread.
///
/// With a scene, the controller has all objects of the scene's authoritative server, and adds,
/// moves and removes them with it. If the server is gone, they stay and become stale. If another
/// server replaces it, they are removed and its objects added.
///
/// Without a scene, the first object of each model follows an object of the model's authoritative
/// server: the one with the least number among those with that model.
class SceneKeeper
{
public:
    /// `reader` must have followed the scene's server, if there is a scene. `authorities`: the
    /// scene's, or one a model; the caller steps them. They and the parts must outlive the keeper.
    /// `log` gets a line for each object that can't be touched, and for each object whose material
    /// is limited.
    SceneKeeper(std::span<const dds::Authority> authorities,
                std::unique_ptr<dds::SceneReader> reader, SceneParts parts, ShownScene scene,
                Log log);

    /// Receives number, generation and name of each object that is added during the run.
    using NameSink = std::function<void(std::uint32_t, std::uint32_t, const std::string&)>;

    /// Connects the output. Call it before the first step(). `mailbox` and `names` must live as
    /// long as the run; `names` may be empty.
    void connect(SceneMailbox& mailbox, MonotonicTime now, NameSink names = {});
    /// Takes the servers' news and passes changes to the mailbox. Never waits.
    void step(MonotonicTime now);

    /// Server's object that our object of this number follows; none if no server shows it.
    [[nodiscard]] std::optional<ServerObject> shown_as(std::uint32_t object) const;
    /// Pose counts, summed over our objects with the model.
    [[nodiscard]] const dds::PoseCounts& counts(std::size_t model) const { return counts_[model]; }
    /// Time when a server that shows the model was last heard; 0: never.
    [[nodiscard]] MonotonicTime heard(std::size_t model) const { return heard_[model]; }
    [[nodiscard]] SceneNewsCounts news() const noexcept
    {
        SceneNewsCounts counts = news_;
        counts.motion_regained = reader_->motion_regained();
        return counts;
    }

private:
    /// Server's object, with its generation: a number may be used again for another object.
    using Generation = std::pair<ServerObject, std::uint32_t>;

    /// One object of the controller.
    struct Slot
    {
        std::optional<ServerObject> bound;
        std::string name; ///< Name of an object added during the run; else empty.
        ObjectSpec spec;
        ObjectPose pose;           ///< Newest pose.
        dds::PoseCounts known;     ///< Pose counts of the server's object that `counts_` includes.
        bool is_resident{false};   ///< True if the object is to be in the frame's scene.
        bool is_told{false};       ///< True if it is there, or its addition is queued.
        bool owes_material{false}; ///< True if a change of its material is still to be queued.
        std::uint32_t generation{0};
    };

    void follow_scene_server();
    void follow_model_servers(MonotonicTime now);
    void take_news(dds::SceneNews news, const dds::SeenObject& object, MonotonicTime now);
    void find_first(std::size_t model, MonotonicTime now);
    void offer(const dds::SeenObject& object, MonotonicTime now);
    void offer_left_out(MonotonicTime now);
    void bind(std::uint32_t place, const dds::SeenObject& object, MonotonicTime now);
    void unbind(std::uint32_t place);
    void move(std::uint32_t place, const dds::SeenObject& object, MonotonicTime now);
    void change_material(std::uint32_t place, const ShownObject& shown);
    [[nodiscard]] Material material_for(const ServerObject& object, const ShownObject& shown);
    void remove_object(std::uint32_t place);
    void pass_on(MonotonicTime now);
    void note_heard(MonotonicTime now);
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
    std::vector<std::uint64_t> servers_; ///< Epochs of the followed servers.
    /// Epoch of each model's server without a scene, or 0.
    std::vector<std::uint64_t> model_servers_;
    /// First object of each model, used without a scene.
    std::vector<std::uint32_t> first_;
    std::vector<Slot> slots_;
    std::map<ServerObject, std::uint32_t> places_; ///< Our numbers of the servers' bound objects.
    std::set<std::uint32_t> free_;                 ///< Our numbers without an object.
    /// Objects with no model of ours, or with a tool's.
    std::set<Generation> passed_over_;
    std::set<Generation> left_out_;  ///< Objects without room, added when room comes.
    std::set<ServerObject> limited_; ///< Objects whose limited material was logged.
    /// Our numbers of the objects whose change is still to be queued.
    std::deque<std::uint32_t> untold_;
    std::vector<dds::PoseCounts> counts_;
    std::vector<MonotonicTime> heard_;
    SceneNewsCounts news_;
};

} // namespace tactus::hrtc
