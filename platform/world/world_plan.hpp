// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "platform/choices/run_options.hpp"
#include "platform/world/program_devices.hpp"
#include "platform/world/world_options.hpp"
#include "platform/world/world_parts.hpp"
#include "rt_core/base/result.hpp"
#include "transport/base/refusal.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::hrtc
{

/// Folder of a World's encoded meshes, made when it is needed and removed with the object.
class MeshFolder
{
public:
    MeshFolder() = default;
    MeshFolder(const MeshFolder&) = delete;
    MeshFolder& operator=(const MeshFolder&) = delete;
    ~MeshFolder();

    /// Encodes a mesh of a file or in memory as a model, as spm_build does without further options.
    /// Returns its path. Refused for what spm_build refuses, for a name that is not valid, and for
    /// a progress callback that throws.
    [[nodiscard]] Result<std::string, Refusal> encode(const WorldModel& model);

private:
    [[nodiscard]] Result<std::filesystem::path, Refusal> file_for(const std::string& name);

    std::filesystem::path folder_; ///< Empty before the first mesh.
    std::size_t count_{0};
};

} // namespace tactus::hrtc

namespace tactus
{

/// Parts of one hand that hrtc's options do not have.
struct HandParts
{
    std::shared_ptr<HapticDevice> own; ///< Null without a device of the program.
    hrtc::HeldDevice* held{nullptr};   ///< The device that the program moves, while it is open.
    bool is_held{false};
    std::optional<HandPose> first_pose;         ///< Pose before the device is open.
    std::unique_ptr<hrtc::CallbackForce> force; ///< Null without a callback.
};

/// Throws and overruns of all force callbacks.
struct CallbackCounts
{
    std::uint64_t throws{0};
    std::uint64_t overruns{0};
};

/// Models, objects and hands of a World as its program adds them, in the options of a run. A
/// refused part changes nothing. It must not move: devices that it makes point to it. Its owner's
/// lock guards it.
class WorldPlan
{
public:
    /// `rate_hz` is the rate of the loop.
    explicit WorldPlan(std::int64_t rate_hz);
    WorldPlan(const WorldPlan&) = delete;
    WorldPlan& operator=(const WorldPlan&) = delete;
    ~WorldPlan() = default;

    [[nodiscard]] hrtc::Options& options() noexcept { return options_; }
    [[nodiscard]] const hrtc::Options& options() const noexcept { return options_; }
    [[nodiscard]] std::vector<HandParts>& hands() noexcept { return hands_; }
    [[nodiscard]] bool has_published() const noexcept { return has_published_; }

    /// Returns the index of the model in the options; a file or a mesh is read first. `is_open` is
    /// false once frames run: then only known models are taken.
    [[nodiscard]] Result<std::size_t, Refusal> take_model(const WorldModel& model, bool is_open);
    /// Undoes take_model() of a refused part; `count` is the number of models before it.
    void forget_models_after(std::size_t count);
    /// Fault of a room for edits that an object of a model reserves; empty if there is none.
    [[nodiscard]] std::optional<Refusal> fault_of_room(std::size_t model, std::uint32_t faces,
                                                       bool is_open) const;
    /// Gives a model at least this room.
    void reserve_room(std::size_t model, std::uint32_t faces);
    /// Takes a scene's file for a run without other objects. Returns its objects, all with a name.
    [[nodiscard]] Result<std::vector<hrtc::PlacedObject>, Refusal>
    take_scene(const std::string& path);
    /// Returns the number of the hand.
    [[nodiscard]] Result<std::uint32_t, Refusal>
    add_hand(const WorldTool& tool, const WorldDevice& device, const HandOptions& options);

    /// Fault of the World's options, beside these parts; empty if there is none.
    [[nodiscard]] std::optional<Refusal> fault_of(const WorldOptions& asked) const;
    /// Takes the World's options over into those of a run.
    void take_options(const WorldOptions& asked, bool is_stepped);

    /// Counts of the force callbacks. Any thread, once frames run.
    [[nodiscard]] CallbackCounts callbacks() const;
    /// Forgets the devices of a run, which has closed them.
    void let_go_of_devices();

private:
    [[nodiscard]] std::string set_shape(hrtc::ToolOptions& made, const WorldTool& tool);
    [[nodiscard]] std::string take_named_mesh(const std::string& name);
    [[nodiscard]] std::string set_device(hrtc::ToolOptions& made, const WorldDevice& device,
                                         HandParts& parts, std::size_t hand);

    std::int64_t rate_hz_;
    hrtc::Options options_;
    hrtc::MeshFolder meshes_;
    std::vector<HandParts> hands_;
    bool has_published_{false};
    bool has_files_{false};
};

/// True for a device whose samples have the machine's time, and which needs the guards of start().
[[nodiscard]] bool runs_in_real_time(const hrtc::ToolOptions& tool);
/// Name of a model's file without folder and ending.
[[nodiscard]] std::string name_of_file(const std::string& path);

} // namespace tactus
