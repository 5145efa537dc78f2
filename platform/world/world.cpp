// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/world/world.hpp"

#include "platform/world/world_core.hpp"

#include <utility>

namespace tactus
{

namespace
{

const std::string kNoError;

Refusal gone()
{
    return {"the World of this handle is gone"};
}

} // namespace

const std::string& WorldObject::error() const noexcept
{
    return refused_ != nullptr ? refused_->text : kNoError;
}

Result<Done, Refusal> WorldObject::move(const Pose& pose) const
{
    const auto world = world_.lock();
    return world != nullptr ? world->move(*this, pose) : gone();
}

Result<Done, Refusal> WorldObject::feel(const MaterialOptions& material) const
{
    const auto world = world_.lock();
    return world != nullptr ? world->feel(*this, material) : gone();
}

Result<Done, Refusal> WorldObject::remove() const
{
    const auto world = world_.lock();
    return world != nullptr ? world->remove(*this) : gone();
}

Result<double, Refusal> WorldObject::carve(const WorldTool& shape, const HandPose& from,
                                           const std::array<double, 3>& to_m) const
{
    const auto world = world_.lock();
    return world != nullptr ? world->carve(*this, shape, from, to_m) : gone();
}

Result<double, Refusal> WorldObject::fill(const WorldTool& shape, const HandPose& from,
                                          const std::array<double, 3>& to_m) const
{
    const auto world = world_.lock();
    return world != nullptr ? world->fill(*this, shape, from, to_m) : gone();
}

Result<double, Refusal> WorldObject::displace(const std::array<double, 3>& center_m,
                                              double radius_m,
                                              const std::array<double, 3>& vector_m) const
{
    const auto world = world_.lock();
    return world != nullptr ? world->displace(*this, center_m, radius_m, vector_m) : gone();
}

Result<Done, Refusal> WorldObject::save(const std::string& path) const
{
    const auto world = world_.lock();
    return world != nullptr ? world->save(*this, path) : gone();
}

const std::string& Hand::error() const noexcept
{
    return refused_ != nullptr ? refused_->text : kNoError;
}

HandState Hand::state() const noexcept
{
    const auto world = world_.lock();
    if (world == nullptr || refused_ != nullptr)
    {
        HandState state;
        state.withheld = Withheld::ended;
        return state;
    }
    return world->state(number_);
}

std::string Hand::why(const HandState& state) const
{
    const auto world = world_.lock();
    return world == nullptr      ? gone().text
           : refused_ != nullptr ? refused_->text
                                 : world->why(number_, state);
}

Result<HandState, Refusal> Hand::step(const HandPose& pose, double dt_s) const
{
    const auto world = world_.lock();
    return world == nullptr      ? Result<HandState, Refusal>(gone())
           : refused_ != nullptr ? *refused_
                                 : world->step(number_, pose, dt_s);
}

Result<Done, Refusal> Hand::hold(const HandPose& pose) const
{
    const auto world = world_.lock();
    return world == nullptr      ? Result<Done, Refusal>(gone())
           : refused_ != nullptr ? *refused_
                                 : world->hold(number_, pose);
}

World::World(WorldOptions options) : core_(std::make_shared<WorldCore>(std::move(options))) {}

World::World(World&& other) noexcept = default;

World& World::operator=(World&& other) noexcept
{
    if (this != &other)
    {
        if (core_ != nullptr)
        {
            static_cast<void>(core_->stop());
        }
        core_ = std::move(other.core_);
    }
    return *this;
}

World::~World()
{
    if (core_ != nullptr)
    {
        static_cast<void>(core_->stop());
    }
}

WorldObject World::add(const WorldModel& model, const ObjectOptions& options)
{
    return core_->add(model, options);
}

WorldObject World::add(const WorldObject& like, const ObjectOptions& options)
{
    return core_->add(like, options);
}

Hand World::add(const WorldTool& tool, const WorldDevice& device, const HandOptions& options)
{
    return core_->add(tool, device, options);
}

std::vector<WorldObject> World::add_scene(const std::string& path)
{
    return core_->add_scene(path);
}

std::optional<Refusal> World::error() const
{
    return core_->error();
}

Result<Done, Refusal> World::start()
{
    return core_->start();
}

Result<Done, Refusal> World::step(double dt_s)
{
    return core_->step(dt_s);
}

Result<Done, Refusal> World::wait()
{
    return core_->wait();
}

Result<Done, Refusal> World::stop()
{
    return core_->stop();
}

bool World::is_running() const noexcept
{
    return core_->is_running();
}

WorldCounts World::counts() const
{
    return core_->counts();
}

} // namespace tactus
