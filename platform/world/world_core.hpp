// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/controller/finished_run.hpp"
#include "platform/world/local_edits.hpp"
#include "platform/world/world.hpp"
#include "platform/world/world_plan.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <future>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace tactus::hrtc
{

class HandTap;
class ProgramScene;
class Session;

} // namespace tactus::hrtc

namespace tactus
{

/// What a World and its handles share. It outlives the World while a call of a handle runs.
class WorldCore : public std::enable_shared_from_this<WorldCore>
{
public:
    explicit WorldCore(WorldOptions options);
    WorldCore(const WorldCore&) = delete;
    WorldCore& operator=(const WorldCore&) = delete;
    ~WorldCore();

    [[nodiscard]] WorldObject add(const WorldModel& model, const ObjectOptions& options);
    [[nodiscard]] WorldObject add(const WorldObject& like, const ObjectOptions& options);
    [[nodiscard]] Hand add(const WorldTool& tool, const WorldDevice& device,
                           const HandOptions& options);
    [[nodiscard]] std::vector<WorldObject> add_scene(const std::string& path);
    [[nodiscard]] std::optional<Refusal> error() const;

    [[nodiscard]] Result<Done, Refusal> start();
    [[nodiscard]] Result<Done, Refusal> step(double dt_s);
    [[nodiscard]] Result<HandState, Refusal> step(std::uint32_t hand, const HandPose& pose,
                                                  double dt_s);
    [[nodiscard]] Result<Done, Refusal> hold(std::uint32_t hand, const HandPose& pose);
    [[nodiscard]] Result<Done, Refusal> wait();
    [[nodiscard]] Result<Done, Refusal> stop();

    [[nodiscard]] Result<Done, Refusal> move(const WorldObject& object, const Pose& pose);
    [[nodiscard]] Result<Done, Refusal> feel(const WorldObject& object,
                                             const MaterialOptions& material);
    [[nodiscard]] Result<Done, Refusal> remove(const WorldObject& object);

    [[nodiscard]] Result<double, Refusal> carve(const WorldObject& object, const WorldTool& shape,
                                                const HandPose& from,
                                                const std::array<double, 3>& to_m);
    [[nodiscard]] Result<double, Refusal> fill(const WorldObject& object, const WorldTool& shape,
                                               const HandPose& from,
                                               const std::array<double, 3>& to_m);
    [[nodiscard]] Result<double, Refusal> displace(const WorldObject& object,
                                                   const std::array<double, 3>& center_m,
                                                   double radius_m,
                                                   const std::array<double, 3>& vector_m);
    [[nodiscard]] Result<Done, Refusal> save(const WorldObject& object, const std::string& path);

    [[nodiscard]] HandState state(std::uint32_t hand) const noexcept;
    [[nodiscard]] std::string why(std::uint32_t hand, const HandState& state) const;
    [[nodiscard]] bool is_running() const noexcept { return phase_.load() == Phase::running; }
    [[nodiscard]] WorldCounts counts() const;

private:
    enum class Phase : std::uint8_t
    {
        open,    ///< Nothing runs yet.
        running, ///< The loop of start() runs.
        stepped, ///< The program runs the frames.
        ended,
    };

    [[nodiscard]] Result<std::size_t, Refusal> model_of(const WorldObject& like) const;
    [[nodiscard]] Result<WorldObject, Refusal> try_add(const WorldModel& model,
                                                       const ObjectOptions& options);
    [[nodiscard]] Result<WorldObject, Refusal> place(std::size_t model,
                                                     const ObjectOptions& options);
    [[nodiscard]] Result<Hand, Refusal> try_add(const WorldTool& tool, const WorldDevice& device,
                                                const HandOptions& options);
    template <typename Handle>
    [[nodiscard]] Handle handle_or_refusal(Result<Handle, Refusal> made);
    template <typename Handle>
    [[nodiscard]] Handle refused_handle(Refusal refusal);
    [[nodiscard]] WorldObject handle_of(std::uint32_t number, std::uint32_t generation);
    [[nodiscard]] std::optional<Refusal> why_not(std::string_view call) const;
    [[nodiscard]] std::optional<Refusal> open(bool is_stepped);
    [[nodiscard]] std::optional<Refusal> try_open(bool is_stepped);
    void close();
    void release();
    void join_keeper();
    void keep_loop(std::promise<std::optional<Refusal>> decided);
    [[nodiscard]] Result<Done, Refusal> run_step(double dt_s, std::optional<std::uint32_t> hand,
                                                 const HandPose& pose);
    [[nodiscard]] Result<Done, Refusal> finished() const;
    [[nodiscard]] std::optional<Refusal> why_not_change(const WorldObject& object,
                                                        std::string_view call) const;
    [[nodiscard]] std::optional<Refusal> why_served(const WorldObject& object,
                                                    std::string_view call) const;
    [[nodiscard]] Result<std::size_t, Refusal> editable_model_of(const WorldObject& object,
                                                                 std::string_view call) const;
    [[nodiscard]] Result<double, Refusal> change(const WorldObject& object, std::string_view call,
                                                 const hrtc::LocalEdits::Change& change);
    void tell_of_callbacks();
    [[nodiscard]] std::string name_of(std::uint32_t object) const;

    /// Guards the members up to first_refusal_, and session_ once the loop has ended. The keeper's
    /// thread takes it only then: start() holds it while that thread opens models and devices.
    mutable std::mutex mutex_;
    WorldOptions asked_;
    WorldPlan plan_;
    std::vector<bool> is_served_; ///< One an object: true if a server moves it.
    std::optional<Refusal> first_refusal_;

    std::mutex joining_; ///< Guards keeper_.
    std::thread keeper_;
    std::atomic<Phase> phase_{Phase::open};
    std::atomic<bool> is_stopping_{false};
    mutable std::mutex names_mutex_;             ///< Guards names_.
    std::map<std::uint32_t, std::string> names_; ///< Names of the objects, by number.
    // Set before phase_ leaves Phase::open; they live as long as the core.
    std::unique_ptr<hrtc::HandTap> tap_;
    std::unique_ptr<hrtc::ProgramScene> scene_;
    std::unique_ptr<hrtc::LocalEdits> edits_; ///< Null if no model of a file has room for edits.
    std::unique_ptr<hrtc::Session> session_;
    std::optional<hrtc::FinishedRun> done_; ///< Results; set before Phase::ended.
    std::uint64_t told_throws_{0};          ///< Throws at the last line of the log.
    std::uint64_t told_overruns_{0};        ///< Overruns at the last line of the log.
};

} // namespace tactus
