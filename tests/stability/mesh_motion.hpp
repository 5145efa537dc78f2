// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/stability/random_motion.hpp"

namespace tactus::test
{

/// State of a mesh tool and of the object in one frame.
struct MeshMoment
{
    ToolState tool;
    ObjectPose pose;
};

/// Smallest sphere around the centre of a tool's box, in the tool frame.
struct ToolSphere
{
    Vec3 middle_m{0.0, 0.0, 0.0};
    double radius_m{0.0};
};
[[nodiscard]] ToolSphere sphere_round(const TestModel& tool);

/// Motion of a mesh tool around an object.
class MeshMotion
{
public:
    MeshMotion() = default;
    MeshMotion(const MeshMotion&) = delete;
    MeshMotion& operator=(const MeshMotion&) = delete;
    MeshMotion(MeshMotion&&) = delete;
    MeshMotion& operator=(MeshMotion&&) = delete;
    virtual ~MeshMotion() = default;

    [[nodiscard]] virtual MeshMoment next() = 0;
    /// Receives the distance of the surfaces in the last frame, for motions that depend on it.
    virtual void feel(double distance_m) { static_cast<void>(distance_m); }
    /// Name of the present activity, for a report.
    [[nodiscard]] virtual const char* activity() const = 0;
};

/// Motion of RandomMotion, applied to some place in or near the tool that changes from time to
/// time. The tool rotates not at all, slowly, fast, or to any orientation at once.
class RandomMeshMotion final : public MeshMotion
{
public:
    /// Starts with an object of this scale. All arguments must outlive the motion.
    RandomMeshMotion(const TestModel& tool, const TestModel& object, const FaceTree& tree,
                     double scale, Random& random);

    [[nodiscard]] MeshMoment next() override;
    [[nodiscard]] const char* activity() const override { return hand_.activity(); }

private:
    void change_grip();

    ToolSphere sphere_;
    Random& random_;
    RandomMotion hand_;
    Eigen::Quaterniond rotation_{Eigen::Quaterniond::Identity()};
    Vec3 grip_m_{0.0, 0.0, 0.0}; ///< Grip in the tool frame.
    Vec3 axis_{0.0, 0.0, 1.0};
    double rate_rad_{0.0};
    std::uint32_t frames_left_{0};
};

/// A tool with the object's own mesh in the object's pose: first exactly, as far as doubles permit,
/// then increasingly displaced to one side after the other.
class CoincidentMotion final : public MeshMotion
{
public:
    CoincidentMotion(const TestModel& tool, const TestModel& object);

    [[nodiscard]] MeshMoment next() override;
    [[nodiscard]] const char* activity() const override { return "coincident"; }

private:
    Vec3 place_m_; ///< Place of the tool frame.
    double diagonal_m_;
    std::uint32_t frame_{0};
};

/// Slide along the surface at 0.1 diag/s with rotation at 0.5 rad/s: descends to the surface, and
/// rises a little when faces meet.
class MeshSlide final : public MeshMotion
{
public:
    /// Starts with an object of this scale at the origin. All arguments must outlive the motion.
    MeshSlide(const TestModel& tool, const TestModel& object, const FaceTree& tree, double scale,
              Random& random);

    [[nodiscard]] MeshMoment next() override;
    void feel(double distance_m) override;
    [[nodiscard]] const char* activity() const override { return "slow slide"; }

private:
    ToolSphere sphere_;
    const FaceTree& tree_;
    double step_m_; ///< Step of a frame, in the world.
    ObjectPose pose_;
    /// Depth below the place where the sphere around the tool touches, in the world.
    double sunk_m_{0.0};
    Vec3 axis_;
    SurfaceSlide slide_;
    std::uint32_t frame_{0};
};

} // namespace tactus::test
