// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/loop/hand_state.hpp"
#include "platform/world/world_options.hpp"
#include "platform/world/world_parts.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus
{

class WorldCore;

/// Handle of an object of a World; a value. Any thread except that of a callback or device of the
/// World. Calls never block the loop. They are refused, in one line, once the object was removed or
/// the World is gone, and for an object that World::add() has refused.
class WorldObject
{
public:
    WorldObject() = default;

    /// False if add() was refused; error() says why.
    [[nodiscard]] explicit operator bool() const noexcept { return !refused_; }
    [[nodiscard]] const std::string& error() const noexcept;
    /// Number in HandContact::object; used again after the object was removed.
    [[nodiscard]] std::uint32_t number() const noexcept { return number_; }

    /// Moves the object to a pose. A running loop blends to it; near a tool no point of the object
    /// is faster than WorldOptions::object_speed_m_per_s.
    [[nodiscard]] Result<Done, Refusal> move(const Pose& pose) const;
    /// Gives the object another material, which tools in contact feel blended in within 50 ms.
    [[nodiscard]] Result<Done, Refusal> feel(const MaterialOptions& material) const;
    /// Removes the object. Refused before the first frame, and like move() for the first object of
    /// a published model while its server moves it (WorldOptions::follows_poses).
    [[nodiscard]] Result<Done, Refusal> remove() const;

    /// Removes from the model what a tool sweeps on its way along a straight line, without
    /// rotation; all objects of the model change. `shape`: a sphere, a capsule, or a box or hull
    /// without a radius. Places are in the model's frame, as it is in its file. Returns the removed
    /// volume there, in m^3. Refused before the first frame, for a model without
    /// ObjectOptions::edit_faces, and for what SurfaceEditor refuses. Takes a few ms; the next
    /// frames have the new surface.
    [[nodiscard]] Result<double, Refusal> carve(const WorldTool& shape, const HandPose& from,
                                                const std::array<double, 3>& to_m) const;
    /// Adds to the model what a tool sweeps, within the model's box. Returns the added volume.
    [[nodiscard]] Result<double, Refusal> fill(const WorldTool& shape, const HandPose& from,
                                               const std::array<double, 3>& to_m) const;
    /// Moves the model's vertices within `radius_m` of `center_m` by
    /// `vector_m` x (1 - d^2 / radius^2)^2 at the distance d. Returns the added volume.
    [[nodiscard]] Result<double, Refusal> displace(const std::array<double, 3>& center_m,
                                                   double radius_m,
                                                   const std::array<double, 3>& vector_m) const;
    /// Writes the model with its edits as one file: the whole file or none. As long as a mesh takes
    /// in World::add(); also after the World has ended.
    [[nodiscard]] Result<Done, Refusal> save(const std::string& path) const;

private:
    friend class World;
    friend class WorldCore;

    std::weak_ptr<WorldCore> world_;
    std::shared_ptr<const Refusal> refused_;
    std::uint32_t number_{0};
    std::uint32_t generation_{0};
};

/// Handle of a tool with its device; a value. Threads and refusals as for WorldObject.
class Hand
{
public:
    Hand() = default;

    [[nodiscard]] explicit operator bool() const noexcept { return !refused_; }
    [[nodiscard]] const std::string& error() const noexcept;
    [[nodiscard]] std::uint32_t number() const noexcept { return number_; }

    /// State after the newest frame; never refused: Withheld::no_frame before the first frame,
    /// Withheld::ended for a hand that is gone. Never waits for the loop; 1 us.
    [[nodiscard]] HandState state() const noexcept;
    /// One line on why `state` has less than the force of the surface, with the object's name;
    /// empty if it has all of it.
    [[nodiscard]] std::string why(const HandState& state) const;

    /// Moves a hand of the program (by_program()) and runs the next frame of the World, on the
    /// calling thread. The first call opens models and devices, and may wait for them; udp, dhd and
    /// plugin devices of other hands need World::start(). `dt_s`: time
    /// since the last frame, in whole periods, at least one and at most a second; more than one
    /// fades the force as in a loop that misses frames. 0: one period. Waits for files; for a loop
    /// in real time use World::start().
    [[nodiscard]] Result<HandState, Refusal> step(const HandPose& pose, double dt_s = 0.0) const;
    /// Moves a hand of the program for the next frames. In the loop of start() a pose older than
    /// 20 ms counts as stuck, and the force fades.
    [[nodiscard]] Result<Done, Refusal> hold(const HandPose& pose) const;

private:
    friend class World;
    friend class WorldCore;

    std::weak_ptr<WorldCore> world_;
    std::shared_ptr<const Refusal> refused_;
    std::uint32_t number_{0};
};

/// Counts since the start.
struct WorldCounts
{
    std::uint64_t frames{0};
    std::uint64_t missed{0};         ///< Deadlines missed, for either reason below.
    std::uint64_t overruns{0};       ///< Frames that took too long.
    std::uint64_t latency_misses{0}; ///< Frames that the machine woke too late.
    std::uint64_t brakes{0};         ///< Brakes by the supervisor.
    std::uint64_t callback_throws{0};
    std::uint64_t callback_overruns{0}; ///< Calls of callbacks longer than a period.
};

/// Objects and hands, and the loop between them: models, devices, frame, force pipeline and guards
/// as `hrtc` has them, in one object. One mode of two:
///
///     loop of start()    a real-time thread with supervisor; state() and hold() from any thread
///     loop of one's own  Hand::step() or step() runs each frame on the calling thread
///
/// Everything is added before the first frame, except objects that show a model which the World has
/// already. A refused add() returns a handle that says why and leaves the World as it was. Without
/// an object or a hand, start() and step() are refused and say why an add() was. One thread uses a
/// World, except for its handles, state, counts() and stop(). A World that was moved from may only
/// be destroyed or assigned to. The loop's assertions brake the devices and end the process
/// (docs/safety.md).
class World
{
public:
    explicit World(WorldOptions options = {});
    World(World&& other) noexcept;
    World& operator=(World&& other) noexcept;
    World(const World&) = delete;
    World& operator=(const World&) = delete;
    /// Ends the loop like stop().
    ~World();

    /// Adds an object that shows a model. Reads a file, or encodes a mesh, at once; a published
    /// model is found at the start. Later than the first frame only for a file or a name that the
    /// World has, and while there are less than WorldOptions::objects_max objects; further objects
    /// of a mesh are added by a handle.
    WorldObject add(const WorldModel& model, const ObjectOptions& options = {});
    /// Adds an object that shows the same model as another one of this World; as above.
    WorldObject add(const WorldObject& like, const ObjectOptions& options = {});
    /// Adds a tool with its device. Only before the first frame.
    Hand add(const WorldTool& tool, const WorldDevice& device = by_program(),
             const HandOptions& options = {});
    /// Adds all objects of a glTF scene as spm_build writes it, with its model files beside it. A
    /// World with a scene has no other objects at the start.
    std::vector<WorldObject> add_scene(const std::string& path);

    /// First refusal of add() before the first frame; none if all were accepted.
    [[nodiscard]] std::optional<Refusal> error() const;

    /// Opens models and devices and starts the loop. Waits at most WorldOptions::wait_s for each. A
    /// refusal changes nothing, and start() may be tried again.
    [[nodiscard]] Result<Done, Refusal> start();
    /// Runs the next frame in a loop of one's own, with all hands where they are; see Hand::step().
    [[nodiscard]] Result<Done, Refusal> step(double dt_s = 0.0);
    /// Waits until the loop of start() has ended by itself: after duration_s, or because another
    /// device took a device's place.
    [[nodiscard]] Result<Done, Refusal> wait();
    /// Ends the loop once the forces have faded; any thread except the loop's own. A World that has
    /// ended keeps its last states, has closed its devices and never runs again. Refused if nothing
    /// has run, or if a recording or trace could not be written; the loop has ended all the same.
    [[nodiscard]] Result<Done, Refusal> stop();

    /// Any thread: true while the loop of start() runs.
    [[nodiscard]] bool is_running() const noexcept;
    /// Any thread: counts after the newest frame.
    [[nodiscard]] WorldCounts counts() const;

private:
    std::shared_ptr<WorldCore> core_;
};

} // namespace tactus
