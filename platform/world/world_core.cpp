// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "platform/world/world_core.hpp"

#include "platform/choices/messages.hpp"
#include "platform/controller/controller.hpp"
#include "platform/controller/session.hpp"
#include "platform/controller/session_run.hpp"
#include "platform/loop/assertion_brake.hpp"
#include "platform/loop/hand_tap.hpp"
#include "platform/machine/posix/posix_clock.hpp"
#include "platform/scene/material_limits.hpp"
#include "platform/scene/program_scene.hpp"
#include "platform/world/program_devices.hpp"
#include "platform/world/world_values.hpp"
#include "rt_core/scene/object_table.hpp"
#include "transport/base/number_form.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <filesystem>
#include <iterator>
#include <system_error>
#include <utility>

namespace tactus
{

namespace
{

using hrtc::failure;

constexpr const char* kOwnThread = "called from a callback or device of the World; call it on "
                                   "another thread";
constexpr const char* kHasEnded = "the World has ended; make a new one";

/// Refusal of a call from a callback or device, whose thread may hold the World's lock.
std::optional<Refusal> fault_of_thread(std::string_view call)
{
    return hrtc::is_in_callback() ? std::optional(failure(fmt::format("{}: {}", call, kOwnThread)))
                                  : std::nullopt;
}

/// Only one loop of a process can brake its devices when an assertion fails (AssertionBrake).
std::atomic<bool> has_loop{false};

} // namespace

WorldCore::WorldCore(WorldOptions options) : asked_(std::move(options)), plan_(asked_.rate_hz) {}

WorldCore::~WorldCore()
{
    is_stopping_.store(true);
    join_keeper();
    if (phase_.load() == Phase::stepped)
    {
        static_cast<void>(session_->finish());
    }
}

template <typename Handle>
Handle WorldCore::handle_or_refusal(Result<Handle, Refusal> made)
{
    if (made)
    {
        return std::move(made).value();
    }
    Refusal refusal = hrtc::in_world_words(made.error());
    if (!first_refusal_ && phase_.load() == Phase::open)
    {
        first_refusal_ = refusal;
    }
    return refused_handle<Handle>(std::move(refusal));
}

template <typename Handle>
Handle WorldCore::refused_handle(Refusal refusal)
{
    Handle handle;
    handle.world_ = weak_from_this();
    handle.refused_ = std::make_shared<const Refusal>(std::move(refusal));
    return handle;
}

WorldObject WorldCore::handle_of(std::uint32_t number, std::uint32_t generation)
{
    WorldObject object;
    object.world_ = weak_from_this();
    object.number_ = number;
    object.generation_ = generation;
    return object;
}

// --- Parts ---------------------------------------------------------------------------------------

WorldObject WorldCore::add(const WorldModel& model, const ObjectOptions& options)
{
    if (auto fault = fault_of_thread("add()"))
    {
        return refused_handle<WorldObject>(*std::move(fault));
    }
    const std::lock_guard lock(mutex_);
    return handle_or_refusal(try_add(model, options));
}

WorldObject WorldCore::add(const WorldObject& like, const ObjectOptions& options)
{
    if (auto fault = fault_of_thread("add()"))
    {
        return refused_handle<WorldObject>(*std::move(fault));
    }
    const std::lock_guard lock(mutex_);
    const auto model = model_of(like);
    return handle_or_refusal(model ? place(model.value(), options)
                                   : Result<WorldObject, Refusal>(model.error()));
}

/// Index of the model that another object shows; the handle may be of any state and World.
Result<std::size_t, Refusal> WorldCore::model_of(const WorldObject& like) const
{
    if (auto refusal = why_not_change(like, "add()"))
    {
        return *std::move(refusal);
    }
    if (like.world_.lock().get() != this)
    {
        return failure("add(): the handle is of no object of this World");
    }
    if (phase_.load() == Phase::open)
    {
        return like.number_ < plan_.options().objects.size()
                   ? Result<std::size_t, Refusal>(plan_.options().objects[like.number_].model)
                   : failure("add(): a World with a scene has no other objects at the start");
    }
    const auto model = scene_->model_of({like.number_, like.generation_});
    return model ? Result<std::size_t, Refusal>(std::size_t{model->value})
                 : failure("add(): the object was removed");
}

Hand WorldCore::add(const WorldTool& tool, const WorldDevice& device, const HandOptions& options)
{
    if (auto fault = fault_of_thread("add()"))
    {
        return refused_handle<Hand>(*std::move(fault));
    }
    const std::lock_guard lock(mutex_);
    return handle_or_refusal(try_add(tool, device, options));
}

std::vector<WorldObject> WorldCore::add_scene(const std::string& path)
{
    if (auto fault = fault_of_thread("add_scene()"))
    {
        return {refused_handle<WorldObject>(*std::move(fault))};
    }
    const std::lock_guard lock(mutex_);
    std::vector<WorldObject> objects;
    const auto refuse = [&](Refusal refusal)
    { objects.push_back(handle_or_refusal<WorldObject>(std::move(refusal))); };
    if (phase_.load() != Phase::open || !plan_.options().objects.empty() ||
        !plan_.options().models.empty())
    {
        refuse(failure(fmt::format("{}: a scene is added first, before the World runs, and brings "
                                   "all objects of the start",
                                   path)));
        return objects;
    }
    auto placed = plan_.take_scene(path);
    if (!placed)
    {
        refuse(placed.error());
        return objects;
    }
    const std::lock_guard naming(names_mutex_);
    for (hrtc::PlacedObject& object : placed.value())
    {
        const auto number = static_cast<std::uint32_t>(objects.size());
        names_[number] = std::move(object.name);
        objects.push_back(handle_of(number, 0));
    }
    return objects;
}

std::optional<Refusal> WorldCore::error() const
{
    if (auto fault = fault_of_thread("error()"))
    {
        return fault;
    }
    const std::lock_guard lock(mutex_);
    return first_refusal_;
}

Result<WorldObject, Refusal> WorldCore::try_add(const WorldModel& model,
                                                const ObjectOptions& options)
{
    if (!plan_.options().scene.empty() && phase_.load() == Phase::open)
    {
        return failure("a World with a scene has no other objects at the start");
    }
    const std::size_t models = plan_.options().models.size();
    const auto taken = plan_.take_model(model, phase_.load() == Phase::open);
    auto placed =
        taken ? place(taken.value(), options) : Result<WorldObject, Refusal>(taken.error());
    if (!placed)
    {
        plan_.forget_models_after(models);
    }
    return placed;
}

/// Adds an object of a known model: to the options before the start, to the scene later.
Result<WorldObject, Refusal> WorldCore::place(std::size_t model, const ObjectOptions& options)
{
    const auto place = checked_place(options.pose);
    if (!place)
    {
        return place.error();
    }
    const auto material = checked_material(options.material);
    if (!material)
    {
        return material.error();
    }
    if (auto fault = plan_.fault_of_room(model, options.edit_faces, phase_.load() == Phase::open))
    {
        return *std::move(fault);
    }
    const Phase phase = phase_.load();
    hrtc::ProgramScene::Key key{static_cast<std::uint32_t>(plan_.options().objects.size()), 0};
    if (phase == Phase::ended)
    {
        return failure(kHasEnded);
    }
    if (phase == Phase::open)
    {
        if (plan_.options().objects.size() == kMaxObjects)
        {
            return failure(fmt::format("a World has at most {} objects", kMaxObjects));
        }
        plan_.options().objects.push_back({.model = model,
                                           .place = place.value(),
                                           .material = material.value(),
                                           .has_place = true,
                                           .has_material = true,
                                           .name = options.name});
        plan_.reserve_room(model, options.edit_faces);
    }
    else
    {
        const auto& controller = session_->controller();
        const std::string& name = controller.models()[model].name;
        if (hrtc::is_of_tool(controller.tools(), model))
        {
            return failure(
                fmt::format("'{}' is the model of a tool; an object needs its own", name));
        }
        if (auto why = hrtc::why_unfelt(name, material.value(), controller.tools()))
        {
            return failure(*why);
        }
        const auto added = scene_->try_add(
            {ModelId{static_cast<std::uint32_t>(model)}, material.value()}, place.value());
        if (!added)
        {
            return failure(fmt::format("objects_max: {} are there already; use a larger value",
                                       counted(controller.object_table().capacity(), "object")));
        }
        key = *added;
    }
    const std::string of_model = phase == Phase::open ? name_of_file(plan_.options().models[model])
                                                      : session_->controller().models()[model].name;
    if (phase != Phase::open)
    {
        session_->name_object(key.number, options.name);
    }
    const std::lock_guard lock(names_mutex_);
    names_[key.number] = options.name.empty() ? of_model : options.name;
    return handle_of(key.number, key.generation);
}

Result<Hand, Refusal> WorldCore::try_add(const WorldTool& tool, const WorldDevice& device,
                                         const HandOptions& options)
{
    if (phase_.load() != Phase::open)
    {
        return failure("the World runs; add each hand before the first frame");
    }
    const auto number = plan_.add_hand(tool, device, options);
    if (!number)
    {
        return number.error();
    }
    Hand hand;
    hand.world_ = weak_from_this();
    hand.number_ = number.value();
    return hand;
}

// --- Start and end -------------------------------------------------------------------------------

/// Reason why a call that begins or needs frames is refused.
std::optional<Refusal> WorldCore::why_not(std::string_view call) const
{
    if (phase_.load() == Phase::ended)
    {
        return failure(fmt::format("{}: {}", call, kHasEnded));
    }
    const bool has_hand = !plan_.options().tools.empty();
    const bool has_object = !plan_.options().objects.empty() || !plan_.options().scene.empty();
    return has_hand && has_object
               ? std::nullopt
               : std::optional(failure(fmt::format(
                     "{}: the World has no {}; {}", call, has_hand ? "object" : "hand",
                     first_refusal_ ? "refused: " + first_refusal_->text : "add one first")));
}

/// Opens models and devices, and makes what the loop shares with the program. A refusal changes
/// nothing.
std::optional<Refusal> WorldCore::open(bool is_stepped)
{
    try
    {
        return try_open(is_stepped);
    }
    catch (const std::exception& exception) // Too little memory, or no more threads.
    {
        close();
        return failure(fmt::format("the World can't begin: {}", exception.what()));
    }
}

std::optional<Refusal> WorldCore::try_open(bool is_stepped)
{
    if (auto refusal = plan_.fault_of(asked_))
    {
        return refusal;
    }
    const auto real = std::ranges::find_if(plan_.options().tools, &runs_in_real_time);
    if (is_stepped && real != plan_.options().tools.end())
    {
        return failure(fmt::format("step(): the device of hand {} runs in real time; use start()",
                                   real - plan_.options().tools.begin()));
    }
    plan_.take_options(asked_, is_stepped);
    std::error_code unread;
    const auto threads =
        std::distance(std::filesystem::directory_iterator("/proc/self/task", unread),
                      std::filesystem::directory_iterator());
    const bool forks =
        plan_.options().has_guardian &&
        std::ranges::any_of(plan_.options().tools, hrtc::wants_guard, &hrtc::ToolOptions::device);
    if (forks && threads > 2) // The caller, which waits, and the keeper, which forks.
    {
        return failure("device: its guardian is a fork, so start the World before other threads, "
                       "or set has_no_guardian");
    }
    hrtc::RunHooks hooks;
    hooks.is_stopped = [this]
    {
        tell_of_callbacks();
        return is_stopping_.load();
    };
    auto session = hrtc::Session::open(plan_.options(), std::move(hooks));
    if (!session)
    {
        close();
        return hrtc::in_world_words(session.error());
    }
    session_ = std::move(session).value();
    const hrtc::Controller& controller = session_->controller();
    scene_ = std::make_unique<hrtc::ProgramScene>(controller.scene_parts(), controller.poses());
    tap_ = std::make_unique<hrtc::HandTap>(controller.tools().size());
    is_served_.assign(controller.objects().size(), false);
    for (const std::uint32_t first : controller.first_objects())
    {
        const bool is_moved = plan_.has_published() && asked_.follows_poses;
        if (is_moved && first < is_served_.size())
        {
            is_served_[first] = true;
        }
    }
    if (!plan_.has_published())
    {
        auto edits = hrtc::LocalEdits::create(controller, session_->options());
        if (!edits)
        {
            close();
            return hrtc::in_world_words(edits.error());
        }
        edits_ = std::move(edits).value();
        if (edits_ != nullptr && !is_stepped)
        {
            edits_->start();
        }
    }
    if (auto refusal = session_->start(scene_.get(), tap_.get(),
                                       edits_ != nullptr ? edits_->ports() : hrtc::ProgramEdits{}))
    {
        close();
        return hrtc::in_world_words(*refusal);
    }
    return std::nullopt;
}

/// Undoes a refused open().
void WorldCore::close()
{
    release();
    edits_.reset();
    tap_.reset();
    scene_.reset();
}

/// Closes models, devices and network. The last states stay.
void WorldCore::release()
{
    session_.reset();
    plan_.let_go_of_devices();
}

Result<Done, Refusal> WorldCore::start()
{
    if (const auto fault = fault_of_thread("start()"))
    {
        return *fault;
    }
    const std::lock_guard lock(mutex_);
    if (const auto refusal = why_not("start()"))
    {
        return *refusal;
    }
    if (phase_.load() != Phase::open)
    {
        return failure(phase_.load() == Phase::running
                           ? "start(): the loop runs already"
                           : "start(): the program runs this World by step()");
    }
    if (has_loop.exchange(true))
    {
        return failure("start(): another World of this process runs its loop; stop it first");
    }
    std::promise<std::optional<Refusal>> decided;
    auto decision = decided.get_future();
    is_stopping_.store(false);
    try
    {
        const std::lock_guard joining(joining_);
        keeper_ = std::thread([this, decided = std::move(decided)]() mutable
                              { keep_loop(std::move(decided)); });
    }
    catch (const std::system_error& error)
    {
        has_loop.store(false);
        return failure(fmt::format("start(): no thread can be started: {}", error.what()));
    }
    if (const auto refusal = decision.get())
    {
        join_keeper();
        has_loop.store(false);
        return *refusal;
    }
    return Done{};
}

/// Body of the keeper's thread, which starts all others and ends them.
void WorldCore::keep_loop(std::promise<std::optional<Refusal>> decided)
{
    hrtc::install_assertion_brake();
    auto refusal = open(false);
    const bool is_refused = refusal.has_value();
    phase_.store(is_refused ? Phase::open : Phase::running);
    decided.set_value(std::move(refusal));
    if (is_refused)
    {
        return;
    }
    session_->running().wait("World");
    hrtc::FinishedRun done = session_->finish();
    if (edits_ != nullptr)
    {
        edits_->stop();
    }
    const std::lock_guard lock(mutex_);
    done_ = std::move(done);
    release();
    has_loop.store(false); // Another World may start as soon as this one is seen to have ended.
    phase_.store(Phase::ended);
}

Result<Done, Refusal> WorldCore::wait()
{
    if (const auto fault = fault_of_thread("wait()"))
    {
        return *fault;
    }
    join_keeper();
    const std::lock_guard lock(mutex_);
    return finished();
}

Result<Done, Refusal> WorldCore::stop()
{
    if (const auto fault = fault_of_thread("stop()"))
    {
        return *fault;
    }
    is_stopping_.store(true); // Also ends the wait of start() and wait() on other threads.
    join_keeper();
    const std::lock_guard lock(mutex_);
    if (phase_.load() == Phase::stepped)
    {
        done_ = session_->finish();
        release();
        phase_.store(Phase::ended);
    }
    return finished();
}

/// Waits for the end of the loop of start(), if there is one; without mutex_, so that handles work
/// meanwhile.
void WorldCore::join_keeper()
{
    const std::lock_guard joining(joining_);
    if (keeper_.joinable())
    {
        keeper_.join();
    }
}

/// Result of a run that has ended, if one has.
Result<Done, Refusal> WorldCore::finished() const
{
    if (!done_)
    {
        return failure("nothing has run");
    }
    if (done_->recording_error)
    {
        return failure("record: " + *done_->recording_error);
    }
    if (done_->trace_error)
    {
        return failure("trace: " + *done_->trace_error);
    }
    return done_->has_other_device
               ? Result<Done, Refusal>(failure("another device took the place of a hand's device"))
               : Done{};
}

// --- Frames --------------------------------------------------------------------------------------

Result<Done, Refusal> WorldCore::step(double dt_s)
{
    if (const auto fault = fault_of_thread("step()"))
    {
        return *fault;
    }
    const std::lock_guard lock(mutex_);
    return run_step(dt_s, std::nullopt, {});
}

Result<HandState, Refusal> WorldCore::step(std::uint32_t hand, const HandPose& pose, double dt_s)
{
    if (const auto fault = fault_of_thread("step()"))
    {
        return *fault;
    }
    const std::lock_guard lock(mutex_);
    const auto done = run_step(dt_s, hand, pose);
    return done ? Result<HandState, Refusal>(tap_->last(hand)) : done.error();
}

/// Runs the next frame, after a hand was moved to the pose. With mutex_.
Result<Done, Refusal> WorldCore::run_step(double dt_s, std::optional<std::uint32_t> hand,
                                          const HandPose& pose)
{
    if (const auto refusal = why_not("step()"))
    {
        return *refusal;
    }
    if (phase_.load() == Phase::running)
    {
        return failure("step(): the loop of start() runs this World; read its state()");
    }
    if (!(dt_s >= 0.0 && std::isfinite(dt_s)))
    {
        return wrong_value(fmt::format("dt_s: {}; 0 or more is allowed", dt_s));
    }
    if (hand && !plan_.hands()[*hand].is_held)
    {
        return failure("step(): a device moves this hand; call World::step()");
    }
    if (const auto fault = hand ? fault_of(pose) : std::nullopt)
    {
        return *fault;
    }
    if (phase_.load() == Phase::open)
    {
        is_stopping_.store(false); // Set by a stop() before anything ran.
        if (const auto refusal = open(true))
        {
            return *refusal;
        }
        phase_.store(Phase::stepped);
    }
    const auto rate = static_cast<double>(asked_.rate_hz);
    const auto periods = static_cast<std::int64_t>(std::clamp(std::round(dt_s * rate), 1.0, rate));
    hrtc::SessionRun& run = session_->running();
    const MonotonicTime time = run.now() + plan_.options().period() * periods;
    for (std::uint32_t i = 0; i < plan_.hands().size(); ++i)
    {
        if (hand == i)
        {
            plan_.hands()[i].held->hold(pose.position_m, pose.rotation, time);
        }
        else if (plan_.hands()[i].held != nullptr)
        {
            plan_.hands()[i].held->keep_until(time);
        }
    }
    if (edits_ != nullptr)
    {
        edits_->step();
    }
    run.step(static_cast<std::uint32_t>(periods));
    tell_of_callbacks();
    return Done{};
}

Result<Done, Refusal> WorldCore::hold(std::uint32_t hand, const HandPose& pose)
{
    if (const auto fault = fault_of_thread("hold()"))
    {
        return *fault;
    }
    if (const auto fault = fault_of(pose))
    {
        return *fault;
    }
    const std::lock_guard lock(mutex_);
    HandParts& parts = plan_.hands()[hand];
    if (!parts.is_held)
    {
        return failure("hold(): a device moves this hand");
    }
    switch (phase_.load())
    {
    case Phase::open:
        parts.first_pose = pose;
        return Done{};
    case Phase::running:
        parts.held->hold(pose.position_m, pose.rotation, PosixClock().now());
        return Done{};
    case Phase::stepped:
        parts.held->hold(pose.position_m, pose.rotation, session_->running().now());
        return Done{};
    case Phase::ended:
        break;
    }
    return failure(fmt::format("hold(): {}", kHasEnded));
}

// --- Objects -------------------------------------------------------------------------------------

/// Reason why an object can't be changed; its handle may be of any state. With mutex_.
std::optional<Refusal> WorldCore::why_not_change(const WorldObject& object,
                                                 std::string_view call) const
{
    if (object.refused_ != nullptr)
    {
        return *object.refused_;
    }
    if (phase_.load() == Phase::ended)
    {
        return failure(fmt::format("{}: {}", call, kHasEnded));
    }
    return std::nullopt;
}

/// Reason why an object of a server is the server's to move. With mutex_.
std::optional<Refusal> WorldCore::why_served(const WorldObject& object, std::string_view call) const
{
    const bool is_served =
        object.generation_ == 0 && object.number_ < is_served_.size() && is_served_[object.number_];
    return is_served ? std::optional(failure(
                           fmt::format("{}: a server moves '{}'; set follows_poses to false", call,
                                       name_of(object.number_))))
                     : std::nullopt;
}

Result<Done, Refusal> WorldCore::move(const WorldObject& object, const Pose& pose)
{
    const auto place = checked_place(pose);
    if (!place)
    {
        return place.error();
    }
    if (const auto fault = fault_of_thread("move()"))
    {
        return *fault;
    }
    const std::lock_guard lock(mutex_);
    if (const auto refusal = why_not_change(object, "move()"))
    {
        return *refusal;
    }
    if (phase_.load() == Phase::open)
    {
        if (object.number_ >= plan_.options().objects.size())
        {
            return failure("move(): the file of a scene places its objects until the first frame");
        }
        plan_.options().objects[object.number_].place = place.value();
        return Done{};
    }
    if (const auto refusal = why_served(object, "move()"))
    {
        return *refusal;
    }
    return scene_->try_move({object.number_, object.generation_}, place.value())
               ? Result<Done, Refusal>(Done{})
               : failure("move(): the object was removed");
}

Result<Done, Refusal> WorldCore::feel(const WorldObject& object, const MaterialOptions& options)
{
    const auto material = checked_material(options);
    if (!material)
    {
        return material.error();
    }
    if (const auto fault = fault_of_thread("feel()"))
    {
        return *fault;
    }
    const std::lock_guard lock(mutex_);
    if (const auto refusal = why_not_change(object, "feel()"))
    {
        return *refusal;
    }
    if (phase_.load() == Phase::open)
    {
        if (object.number_ >= plan_.options().objects.size())
        {
            return failure("feel(): the file of a scene has its materials until the first frame");
        }
        plan_.options().objects[object.number_].material = material.value();
        return Done{};
    }
    if (auto why = hrtc::why_unfelt(name_of(object.number_), material.value(),
                                    session_->controller().tools()))
    {
        return failure(*why);
    }
    return scene_->try_set_material({object.number_, object.generation_}, material.value())
               ? Result<Done, Refusal>(Done{})
               : failure("feel(): the object was removed");
}

Result<Done, Refusal> WorldCore::remove(const WorldObject& object)
{
    if (const auto fault = fault_of_thread("remove()"))
    {
        return *fault;
    }
    const std::lock_guard lock(mutex_);
    if (const auto refusal = why_not_change(object, "remove()"))
    {
        return *refusal;
    }
    if (phase_.load() == Phase::open)
    {
        return failure("remove(): an object leaves after the first frame; before it, don't add it");
    }
    if (const auto refusal = why_served(object, "remove()"))
    {
        return *refusal; // The server's poses would move the next object of this number.
    }
    return scene_->try_remove({object.number_, object.generation_})
               ? Result<Done, Refusal>(Done{})
               : failure("remove(): the object was removed before");
}

// --- Edits ---------------------------------------------------------------------------------------

/// Model of an object that the program may edit; the handle may be of any state. With mutex_.
Result<std::size_t, Refusal> WorldCore::editable_model_of(const WorldObject& object,
                                                          std::string_view call) const
{
    if (object.refused_ != nullptr)
    {
        return *object.refused_;
    }
    if (phase_.load() == Phase::open)
    {
        return failure(fmt::format("{}: edits begin with the first frame", call));
    }
    const auto model = scene_->model_of({object.number_, object.generation_});
    if (!model)
    {
        return failure(fmt::format("{}: the object was removed", call));
    }
    if (plan_.has_published())
    {
        return failure(fmt::format("{}: '{}' is of a server, which edits it; use the hand's edit",
                                   call, name_of(object.number_)));
    }
    return edits_ != nullptr && edits_->has_room(model->value)
               ? Result<std::size_t, Refusal>(std::size_t{model->value})
               : failure(fmt::format("{}: '{}' has no room for edits; set edit_faces", call,
                                     name_of(object.number_)));
}

/// Changes the model of an object. Without mutex_, so that no other call waits for it.
Result<double, Refusal> WorldCore::change(const WorldObject& object, std::string_view call,
                                          const hrtc::LocalEdits::Change& change)
{
    if (auto fault = fault_of_thread(call))
    {
        return *std::move(fault);
    }
    const auto model = [&]
    {
        const std::lock_guard lock(mutex_);
        return phase_.load() == Phase::ended
                   ? Result<std::size_t, Refusal>(failure(fmt::format("{}: {}", call, kHasEnded)))
                   : editable_model_of(object, call);
    }();
    if (!model)
    {
        return model.error();
    }
    auto changed = edits_->change(model.value(), change);
    return changed
               ? changed
               : Result<double, Refusal>(Refusal{fmt::format("{}: {}", call, changed.error().text),
                                                 changed.error().is_usage});
}

Result<double, Refusal> WorldCore::carve(const WorldObject& object, const WorldTool& shape,
                                         const HandPose& from, const std::array<double, 3>& to_m)
{
    return change(object, "carve()",
                  [&](SurfaceEditor& editor) -> Result<SurfaceChange, Refusal>
                  {
                      const auto sweep = checked_sweep(shape, from, to_m);
                      return sweep ? editor.carve(sweep.value()) : sweep.error();
                  });
}

Result<double, Refusal> WorldCore::fill(const WorldObject& object, const WorldTool& shape,
                                        const HandPose& from, const std::array<double, 3>& to_m)
{
    return change(object, "fill()",
                  [&](SurfaceEditor& editor) -> Result<SurfaceChange, Refusal>
                  {
                      const auto sweep = checked_sweep(shape, from, to_m);
                      return sweep ? editor.fill(sweep.value()) : sweep.error();
                  });
}

Result<double, Refusal> WorldCore::displace(const WorldObject& object,
                                            const std::array<double, 3>& center_m, double radius_m,
                                            const std::array<double, 3>& vector_m)
{
    return change(object, "displace()",
                  [&](SurfaceEditor& editor)
                  {
                      return editor.displace({center_m[0], center_m[1], center_m[2]}, radius_m,
                                             {vector_m[0], vector_m[1], vector_m[2]});
                  });
}

Result<Done, Refusal> WorldCore::save(const WorldObject& object, const std::string& path)
{
    if (const auto fault = fault_of_thread("save()"))
    {
        return *fault;
    }
    const auto model = [&]
    {
        const std::lock_guard lock(mutex_);
        return editable_model_of(object, "save()");
    }();
    return model ? edits_->save(model.value(), path) : model.error();
}

// --- State ---------------------------------------------------------------------------------------

HandState WorldCore::state(std::uint32_t hand) const noexcept
{
    const Phase phase = phase_.load();
    if (phase == Phase::open)
    {
        return {};
    }
    HandState state = tap_->state(hand);
    if (phase == Phase::ended)
    {
        state.force_n = {};
        state.torque_nm = {};
        state.withheld = Withheld::ended;
    }
    return state;
}

std::string WorldCore::why(std::uint32_t hand, const HandState& state) const
{
    if (state.withheld == Withheld::overlap)
    {
        return fmt::format("hand {} overlaps '{}' since one of them came: no force until it is "
                           "clear",
                           hand, name_of(state.withheld_object));
    }
    if (state.withheld == Withheld::nothing && state.began_inside)
    {
        return fmt::format("hand {} began inside a closed object, whose surface keeps it inside",
                           hand);
    }
    return text_of(state.withheld);
}

WorldCounts WorldCore::counts() const
{
    WorldCounts counts;
    if (phase_.load() == Phase::open)
    {
        return counts;
    }
    const hrtc::LoopCounts loop = tap_->counts();
    counts.frames = loop.frames;
    counts.missed = loop.missed;
    counts.overruns = loop.overruns;
    counts.latency_misses = loop.latency_misses;
    counts.brakes = tap_->brakes();
    const CallbackCounts callbacks = plan_.callbacks(); // The hands no longer change.
    counts.callback_throws = callbacks.throws;
    counts.callback_overruns = callbacks.overruns;
    return counts;
}

std::string WorldCore::name_of(std::uint32_t object) const
{
    const std::lock_guard lock(names_mutex_);
    const auto found = names_.find(object);
    return found != names_.end() ? found->second : fmt::format("object {}", object);
}

/// Logs throws and overruns of callbacks at the first one, at ten, at a hundred, and so on. Thread
/// that watches the loop.
void WorldCore::tell_of_callbacks()
{
    const auto [throws, overruns] = plan_.callbacks();
    if (throws >= std::max<std::uint64_t>(10 * told_throws_, 1))
    {
        told_throws_ = throws;
        hrtc::log_line(fmt::format("a force callback has thrown, {}: its force was zero",
                                   counted(throws, "time")));
    }
    if (overruns >= std::max<std::uint64_t>(10 * told_overruns_, 1))
    {
        told_overruns_ = overruns;
        hrtc::log_line(fmt::format("a force callback took longer than a period, {}",
                                   counted(overruns, "time")));
    }
}

} // namespace tactus
