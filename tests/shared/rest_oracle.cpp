// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/rest_oracle.hpp"

#include "tests/shared/shape_oracle.hpp"

#include <Eigen/Dense>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace tactus::test
{

namespace
{

constexpr double kReach_m = 0.002; ///< Search distance beyond the radius.
constexpr double kStep = 1e-7;     ///< Step of differences, in metres and radians.
constexpr int kRounds = 200;       ///< Rounds for each stiffness.
/// Greatest step as a share of the radius: a longer one could jump over a face, which has no cost
/// on its other side.
constexpr double kLongestStep = 0.5;

using Vector6 = Eigen::Matrix<double, 6, 1>;

Vec3 vector_of(const Mat3& rotation)
{
    const Eigen::AngleAxisd turned(rotation);
    return turned.angle() * turned.axis();
}

/// Face of the source with the core's faces that it may touch.
struct Pair
{
    Triangle face;
    std::vector<Triangle> core;
};

class Energy
{
public:
    Energy(const SolidCore& tool, const std::vector<Face>& faces, const Springs& springs,
           const Similarity& hand, const Similarity& near)
        : radius_m_(tool.radius_m), hand_(hand)
    {
        arm_m_ = std::sqrt(springs.stiffness_nm_per_rad / springs.stiffness_n_per_m);
        for (const Triangle& part : tool.faces)
        {
            size_m_ = std::max({size_m_, part[0].norm(), part[1].norm(), part[2].norm()});
        }
        for (const Face& face : faces)
        {
            Pair pair{to_triangle(face), {}};
            for (const Triangle& part : tool.faces)
            {
                const double gap_m = distance(placed(part, near), pair.face);
                if (gap_m <= radius_m_ + kReach_m)
                {
                    pair.core.push_back(part);
                }
            }
            if (!pair.core.empty())
            {
                pairs_.push_back(std::move(pair));
            }
        }
    }

    /// Residuals; half of their squared norm is the energy divided by the stiffness.
    [[nodiscard]] Eigen::VectorXd at(const Similarity& place, double hardness) const
    {
        Eigen::VectorXd parts(6 + static_cast<Eigen::Index>(pairs_.size()));
        parts.head<3>() = place.translation_m - hand_.translation_m;
        parts.segment<3>(3) = arm_m_ * vector_of(place.rotation * hand_.rotation.transpose());
        Eigen::Index row = 6;
        for (const Pair& pair : pairs_)
        {
            parts[row++] = std::sqrt(hardness) * std::max(0.0, depth_m(pair, place));
        }
        return parts;
    }
    [[nodiscard]] double deepest_m(const Similarity& place, int& faces) const
    {
        double deepest = 0.0;
        for (const Pair& pair : pairs_)
        {
            deepest = std::max(deepest, depth_m(pair, place));
            faces += depth_m(pair, place) > 0.0 ? 1 : 0;
        }
        return deepest;
    }
    /// Part of a motion that is a step of the search.
    [[nodiscard]] Vector6 step_of(const Vector6& motion) const
    {
        const double way_m = motion.head<3>().norm() + size_m_ * motion.tail<3>().norm();
        const double longest_m = kLongestStep * radius_m_;
        return way_m > longest_m ? Vector6(motion * (longest_m / way_m)) : motion;
    }

private:
    static Triangle placed(const Triangle& part, const Similarity& place)
    {
        return {place.local_to_world(part[0]), place.local_to_world(part[1]),
                place.local_to_world(part[2])};
    }
    static double distance(const Triangle& part, const Triangle& face)
    {
        return ShapeOracle<double>::distance(std::span<const Vec3>(part), face);
    }
    [[nodiscard]] double depth_m(const Pair& pair, const Similarity& place) const
    {
        double depth = -kReach_m;
        for (const Triangle& part : pair.core)
        {
            depth = std::max(depth, radius_m_ - distance(placed(part, place), pair.face));
        }
        return depth;
    }

    double radius_m_;
    double arm_m_{1.0};
    double size_m_{0.0}; ///< Greatest distance of the core's corners from its origin.
    Similarity hand_;
    std::vector<Pair> pairs_;
};

Similarity moved(const Similarity& place, const Vector6& motion)
{
    const Vec3 turn = motion.tail<3>();
    const double angle = turn.norm();
    const Mat3 by = angle > 0.0 ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix()
                                : Mat3(Mat3::Identity());
    return {by * place.rotation, place.translation_m + motion.head<3>(), 1.0};
}

/// Descends from `place` until no step helps.
Similarity least(const Energy& energy, Similarity place, double hardness)
{
    Eigen::VectorXd now = energy.at(place, hardness);
    double damping = 1e-3;
    for (int round = 0; round < kRounds && damping < 1e12; ++round)
    {
        Eigen::MatrixXd slope(now.size(), 6);
        for (int i = 0; i < 6; ++i)
        {
            const Vector6 step = kStep * Vector6::Unit(i);
            slope.col(i) = (energy.at(moved(place, step), hardness) -
                            energy.at(moved(place, -step), hardness)) /
                           (2.0 * kStep);
        }
        const Eigen::Matrix<double, 6, 6> square = slope.transpose() * slope;
        const Vector6 down = slope.transpose() * now;
        for (bool is_better = false; !is_better && damping < 1e12;)
        {
            Eigen::Matrix<double, 6, 6> damped = square;
            damped.diagonal() *= 1.0 + damping;
            const Similarity tried = moved(place, energy.step_of(-damped.ldlt().solve(down)));
            const Eigen::VectorXd then = energy.at(tried, hardness);
            is_better = then.squaredNorm() < now.squaredNorm();
            damping = is_better ? std::max(1e-9, 0.2 * damping) : 4.0 * damping;
            place = is_better ? tried : place;
            now = is_better ? then : now;
        }
    }
    return place;
}

} // namespace

Rest rest_of(const SolidCore& tool, const std::vector<Face>& faces, const Springs& springs,
             const Similarity& hand, const Similarity& near)
{
    const Energy energy(tool, faces, springs, hand, near);
    Rest rest{near};
    for (const double hardness : {1e2, 1e4, 1e6})
    {
        rest.place = least(energy, rest.place, hardness);
    }
    rest.force_n = springs.stiffness_n_per_m * (rest.place.translation_m - hand.translation_m);
    rest.torque_nm =
        springs.stiffness_nm_per_rad * vector_of(rest.place.rotation * hand.rotation.transpose());
    rest.deepest_m = energy.deepest_m(rest.place, rest.faces);
    return rest;
}

} // namespace tactus::test
