// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "tests/stability/random_motion.hpp"

namespace tactus::test
{

/// A tool that is a mesh and the object, in one frame.
struct MeshMoment
{
    ToolState tool;
    ObjectPose pose;
};

/// The smallest ball round the middle of a tool's box, in the tool's frame.
struct ToolBall
{
    Vec3 middle_m{0.0, 0.0, 0.0};
    double radius_m{0.0};
};
[[nodiscard]] ToolBall ball_round(const TestModel& tool);

/// Moves a tool that is a mesh round an object.
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
    /// How far apart the surfaces were in the last frame, for those who feel their way.
    virtual void feel(double distance_m) { static_cast<void>(distance_m); }
    /// What is being done, for a report.
    [[nodiscard]] virtual const char* activity() const = 0;
};

/// RandomMotion's hand holds some place in or near the tool, another one from time to time, and
/// turns it: not at all, slowly, fast, or to any other side at once.
class RandomMeshMotion final : public MeshMotion
{
public:
    /// All of them must outlive the motion. The object has this scale.
    RandomMeshMotion(const TestModel& tool, const TestModel& object, const FaceTree& tree,
                     double scale, Random& random);

    [[nodiscard]] MeshMoment next() override;
    [[nodiscard]] const char* activity() const override { return hand_.activity(); }

private:
    void change_grip();

    ToolBall ball_;
    Random& random_;
    RandomMotion hand_;
    Eigen::Quaterniond rotation_{Eigen::Quaterniond::Identity()};
    Vec3 grip_m_{0.0, 0.0, 0.0}; ///< In the tool's frame.
    Vec3 axis_{0.0, 0.0, 1.0};
    double rate_rad_{0.0};
    std::uint32_t frames_left_{0};
};

/// A tool that is the object's own mesh, where the object is: first exactly, as far as positions
/// are doubles, then ever farther off, to one side after the other.
class CoincidentMotion final : public MeshMotion
{
public:
    CoincidentMotion(const TestModel& tool, const TestModel& object);

    [[nodiscard]] MeshMoment next() override;
    [[nodiscard]] const char* activity() const override { return "coincident"; }

private:
    Vec3 place_m_; ///< Of the tool's frame.
    double diagonal_m_;
    std::uint32_t frame_{0};
};

/// Slides along the surface at 0.1 diag/s, turning at half a radian a second: down to the surface,
/// and up a little whenever faces meet.
class MeshSlide final : public MeshMotion
{
public:
    /// All of them must outlive the motion. The object has this scale and is at the origin.
    MeshSlide(const TestModel& tool, const TestModel& object, const FaceTree& tree, double scale,
              Random& random);

    [[nodiscard]] MeshMoment next() override;
    void feel(double distance_m) override;
    [[nodiscard]] const char* activity() const override { return "slow slide"; }

private:
    ToolBall ball_;
    const FaceTree& tree_;
    double step_m_; ///< Of a frame, in the world.
    ObjectPose pose_;
    double sunk_m_{0.0}; ///< Below where the ball round the tool touches, in the world.
    Vec3 axis_;
    SurfaceSlide slide_;
    std::uint32_t frame_{0};
};

} // namespace tactus::test
