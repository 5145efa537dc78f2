// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/realtime.hpp"
#include "rt_core/base/static_vector.hpp"
#include "rt_core/force/half_spaces.hpp"
#include "rt_core/force/symmetric_factor.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/math/vec3.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace tactus
{

/// Largest number of contacts with a friction pyramid, of four planes each.
inline constexpr std::size_t kTiltedContacts = kMaxHalfSpaces / 4;

/// Possible contact of a rigid tool with a surface; world frame.
struct RigidTouch
{
    std::uint32_t surface{0}; ///< Index of the surface among those of the step.
    Vec3 on_tool_m{0.0, 0.0, 0.0};
    Vec3 on_surface_m{0.0, 0.0, 0.0};
    Vec3 normal{0.0, 0.0, 0.0}; ///< Direction from the surface to the tool.
    /// True if the touch is inside a face, whose normal is then `normal`.
    bool is_face{false};
};

/// Material of the surface at a touch.
struct RigidGrip
{
    double stiffness_n_per_m{0.0};
    double friction{0.0}; ///< Friction coefficient in use now.
    double dynamic{0.0};  ///< Friction coefficient while sliding.
    double damping_n_s_per_m{0.0};
    /// Viscosity: displacement along the surface in this frame per stretch of the spring that
    /// resists it.
    double viscous{0.0};
    Vec3 velocity_m_per_s{0.0, 0.0, 0.0}; ///< Velocity of the surface.
    /// Displacement of the surface in this step, along which friction carries the tool.
    Vec3 way_m{0.0, 0.0, 0.0};
    Vec3 frame_way_m{0.0, 0.0, 0.0}; ///< Displacement of the surface in the whole frame.
};

/// Push of a plane on a rigid tool: it holds back the motion `reaction` x `normal`.
struct RigidPush
{
    std::uint32_t touch{0};
    Motion<6> normal{Motion<6>::Zero()};
    double reaction{0.0};
};

/// Motion of a rigid tool that planes and friction allow, and the pushes at its end.
struct RigidMotion
{
    Motion<6> motion{Motion<6>::Zero()};
    StaticVector<RigidPush, 6> pushes;
    bool slides{false};              ///< True if the tool slides against friction.
    bool sticks{false};              ///< True if friction holds the tool in place.
    bool is_over_constrained{false}; ///< True if all planes together allow no motion.
};

/// Planes of one step of a rigid tool, and the motion that they and Coulomb friction allow.
///
/// Motions are six numbers: a displacement in metres, and a rotation vector times the arm. Half the
/// stiffness times the squared length is the energy of the coupling's springs, so the motion
/// nearest to the wanted one is where they come to rest.
///
/// Friction (Moreau 1966): the plane of a contact is tilted into the four planes of its friction
/// pyramid, with the normals: normal +- coefficient x tangent. The first tangent is along the
/// displacement that the device wants there. If the device's pull lies within the cone of all
/// pyramids, the nearest motion that tilted planes allow is zero: the tool sticks. A sliding tool
/// would be lifted by tilted planes. So the friction is added to the wanted motion, and the plain
/// planes are solved: once, and once more with the friction that their pressure allows.
///
/// Viscosity: each pressing contact of a sliding tool is an implicit damper, as in Proxy. The
/// dampers' energy is added to the metric: planes and wanted motion are transformed by its Cholesky
/// factor, and the result back.
///
/// Seams: if a tool is over one face, the next face seems to lean against it, since its nearest
/// point is the shared edge. Such a plane would stop the tool half-way to the edge and drag at a
/// sliding tool. It is left out if touches on the first face's plane support the tool there from
/// all sides.
///
/// Scratch memory of 23 KiB, too large for a frame's stack. Haptic thread. Cost: 0.7 to 5 us
/// without friction, at most 10 us more with friction.
class RigidPlanes
{
public:
    /// Clears the planes for a step of a tool at `place_m`. `arm_m` is the arm of the metric,
    /// `size_m` the size of the tool, and `gone` the motion of the earlier steps of the frame.
    void begin(const Vec3& place_m, double arm_m, double size_m, double radius_m,
               const Motion<6>& gone) noexcept TACTUS_NONBLOCKING;
    /// Adds the plane of a touch. If the list is full, replaces the plane that restrains least, and
    /// exceeds_capacity() is true.
    void add(const RigidTouch& touch, const RigidGrip& grip) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] RigidMotion nearest(const Motion<6>& wanted) noexcept TACTUS_NONBLOCKING;

    [[nodiscard]] bool exceeds_capacity() const noexcept { return exceeds_capacity_; }
    [[nodiscard]] const RigidTouch& touch(std::uint32_t i) const noexcept { return touches_[i]; }
    [[nodiscard]] const RigidGrip& grip(std::uint32_t i) const noexcept { return grips_[i]; }
    /// Lever of touch `i`: vector from the tool's place to the point of the tool's outside nearest
    /// to the surface.
    [[nodiscard]] Vec3 lever_m(std::uint32_t i) const noexcept TACTUS_NONBLOCKING;

private:
    /// One corner of a contact's friction pyramid.
    struct Tilt
    {
        std::uint32_t touch{0};
        Motion<6> drag{Motion<6>::Zero()}; ///< Friction coefficient x tangent.
    };
    using Chosen = StaticVector<std::uint32_t, kTiltedContacts>;

    /// Plane of one or more touched faces, and the touching part of the tool.
    struct Ground
    {
        /// Coordinates of a point along 8 directions in the plane.
        using Heights = std::array<double, 8>;

        std::uint32_t face; ///< Index of the touch of the nearest of these faces.
        Vec3 first;         ///< First unit axis in the plane.
        Vec3 second;        ///< Second unit axis in the plane.
        /// Largest coordinates of the touching points of the tool, from the tool's place.
        Heights high_m{};
        Heights low_m{}; ///< Smallest coordinates of the same points.

        Ground(std::uint32_t nearest, const Vec3& normal) noexcept;
        [[nodiscard]] Heights heights(const Vec3& point_m) const noexcept;
        void support(const Vec3& point_m) noexcept;
        [[nodiscard]] bool is_among_supports(const Vec3& point_m, double off_m) const noexcept;
    };
    /// Seams at further planes of faces are not left out.
    static constexpr std::size_t kMaxGrounds = 8;
    using Grounds = StaticVector<Ground, kMaxGrounds>;

    [[nodiscard]] Grounds grounds() const noexcept;
    [[nodiscard]] bool is_seam(std::size_t plane, const Ground& ground) const noexcept;
    void leave_out_seams() noexcept;
    void replace(std::size_t plane, const HalfSpace<6>& space, const RigidTouch& touch,
                 const RigidGrip& grip) noexcept;
    [[nodiscard]] double apart_sq(const HalfSpace<6>& a, const HalfSpace<6>& b) const noexcept;
    [[nodiscard]] NearestMotion<6> plain(const Motion<6>& wanted,
                                         bool& is_over_constrained) noexcept;
    [[nodiscard]] Chosen choose(const NearestMotion<6>& plain) const noexcept;
    void tilt(const Chosen& chosen, const Motion<6>& wanted) noexcept;
    void tilt(std::uint32_t touch, const Motion<6>& wanted) noexcept;
    [[nodiscard]] bool is_stuck(const NearestMotion<6>& tilted) const noexcept;
    [[nodiscard]] RigidMotion stuck(const NearestMotion<6>& tilted) noexcept;
    [[nodiscard]] RigidMotion sliding(const NearestMotion<6>& tilted,
                                      const Motion<6>& wanted) noexcept;
    /// Share of the dampers: (metric - 1) x motion for this step, `gone` for the frame's earlier
    /// motion.
    struct Viscosity
    {
        SymmetricFactor factor; ///< Cholesky factor of the metric with the dampers.
        Motion<6> gone{Motion<6>::Zero()};
    };

    [[nodiscard]] bool drags(const NearestMotion<6>& held, std::size_t i) const noexcept;
    [[nodiscard]] std::optional<Viscosity>
    viscosity_of(const NearestMotion<6>& held) const noexcept;
    void rub(const NearestMotion<6>& held, const Motion<6>& wanted, const Motion<6>& drag,
             RigidMotion& answer) noexcept;
    [[nodiscard]] double share_of(const NearestMotion<6>& plain, double most) const noexcept;

    StaticVector<HalfSpace<6>, kMaxHalfSpaces> spaces_;
    StaticVector<RigidTouch, kMaxHalfSpaces> touches_;
    StaticVector<RigidGrip, kMaxHalfSpaces> grips_;
    /// Planes of the pyramids, then plain planes of contacts without one.
    StaticVector<HalfSpace<6>, kMaxHalfSpaces> tilted_;
    StaticVector<Tilt, kMaxHalfSpaces> tilts_; ///< Tilts of the pyramids' planes in tilted_.
    /// Indices of the touches of the plain planes in tilted_.
    StaticVector<std::uint32_t, kMaxHalfSpaces> untilted_;
    Vec3 place_m_{0.0, 0.0, 0.0};
    Motion<6> gone_{Motion<6>::Zero()};
    double arm_m_{1.0};
    /// Weight of the rotational part when two planes are compared, so that the tool's size is the
    /// arm.
    double turn_weight_{1.0};
    double radius_m_{0.0};
    bool exceeds_capacity_{false};
};

} // namespace tactus
