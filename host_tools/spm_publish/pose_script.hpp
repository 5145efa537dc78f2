// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/records/material.hpp"
#include "transport/base/refusal.hpp"
#include "transport/pose.hpp"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace tactus
{

/// Form of a line of a pose file; for messages.
inline constexpr std::string_view kPoseLineForm = "TIME_S NAME X Y Z QX QY QZ QW [SCALE]";
/// Word in place of the pose that removes the object.
inline constexpr std::string_view kGoneWord = "gone";
/// Word in place of the pose that changes the material, and the form of that line.
inline constexpr std::string_view kMaterialWord = "material";
inline constexpr std::string_view kMaterialLineForm = "TIME_S NAME material KEY=VALUE[,...]";

/// Maximum bytes of a pose file, and maximum time in one.
inline constexpr std::size_t kPoseFileBytesMax = 64U << 20U;
inline constexpr double kPoseTimeMax_s = 1e6;

/// One line of a pose file, checked.
struct PoseLine
{
    double time_s{0.0};    ///< Time from the start of play.
    std::size_t object{0}; ///< Index into the objects of the script.
    /// New pose, if any. Without pose and material the object is removed.
    std::optional<Pose> pose;
    std::optional<Material> material; ///< New material, if any; the pose then stays.
};

/// An object that lines may name.
struct ScriptedObject
{
    std::string name;
    double scale{1.0}; ///< Scale until a line sets another.
};

/// Reads a pose file's text: lines of these forms in the order of their times; empty lines and
/// those that begin with # are ignored. A pose without SCALE keeps the object's previous scale. A
/// refusal begins with the line's number.
[[nodiscard]] Result<std::vector<PoseLine>, Refusal>
parse_pose_lines(std::string_view text, std::span<const ScriptedObject> objects);

/// Reads a pose file; a refusal begins with its name.
[[nodiscard]] Result<std::vector<PoseLine>, Refusal>
read_pose_file(const std::filesystem::path& path, std::span<const ScriptedObject> objects);

/// Maximum number of lines that interpolated() returns.
inline constexpr std::size_t kInterpolatedLinesMax = 2'000'000;
/// Range of rates for interpolated(), in Hz.
inline constexpr double kPosesRateMin_hz = 1.0;
inline constexpr double kPosesRateMax_hz = 1'000.0;

/// Adds lines between successive lines of each object, `rate_hz` a second: translations and scales
/// linearly, rotations by the shortest way at constant speed. Nothing is added while the object is
/// removed. Refused above kInterpolatedLinesMax lines.
[[nodiscard]] Result<std::vector<PoseLine>, Refusal>
interpolated(std::span<const PoseLine> lines, std::size_t objects, double rate_hz);

/// Plays lines in real time. If several lines of one object are due, only its newest pose and its
/// newest material are sent.
class PosePlayer
{
public:
    /// `lines` must not be empty; with `loops`, the last one's time, at which play restarts, must
    /// be above 0.
    PosePlayer(std::vector<PoseLine> lines, std::size_t objects, bool loops);

    /// The newest lines that are due and were not returned yet: for each object its material, then
    /// its pose. `now_s` never decreases.
    [[nodiscard]] std::vector<PoseLine> take_due(double now_s);

    /// Time of the next line; none if all have been played.
    [[nodiscard]] std::optional<double> next_s() const;

private:
    std::vector<PoseLine> lines_;
    std::size_t objects_;
    bool loops_;
    double round_start_s_{0.0};
    std::size_t next_{0};
};

} // namespace tactus
