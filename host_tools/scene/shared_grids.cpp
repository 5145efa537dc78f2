// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/scene/shared_grids.hpp"

#include "host_tools/mesh/mesh_places.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numeric>

namespace tactus
{

namespace
{

/// Distance within which places are equal, as a share of the object's size: ten times the rounding
/// of floats.
constexpr double kSamePlace = 1e-6;
constexpr double kSameTurn = 1e-9;
constexpr std::size_t kLeastCommon = 2;
/// Maximum number of other models with which a model is compared at one corner.
constexpr std::size_t kPairsOfEach = 16;

std::uint64_t mixed(std::uint64_t hash, std::int64_t value)
{
    hash ^= std::bit_cast<std::uint64_t>(value);
    hash *= 0x9E37'79B9'7F4A'7C15U;
    return hash ^ hash >> 29U;
}

std::int64_t in_steps(double value, double step)
{
    return std::llround(value / step);
}

} // namespace

SharedGrids::SharedGrids(std::size_t models, std::size_t corners_max)
    : models_(models), corners_max_(corners_max)
{
}

void SharedGrids::add(std::size_t model, const Pose& pose, const TriangleMesh& mesh)
{
    const Eigen::AlignedBox3d box = box_of(mesh);
    const double size_m = box.isEmpty() ? 0.0 : pose.scale * box.sizes().maxCoeff();
    if (!(size_m > 0.0) || !std::isfinite(size_m))
    {
        return;
    }
    // The step is a power of 16, so that objects of similar size have equal steps.
    const int exponent = 4 * static_cast<int>(std::floor(std::ilogb(kSamePlace * size_m) / 4.0));
    const double step_m = std::ldexp(1.0, exponent + 4);
    const Eigen::Matrix3d rotation = Eigen::Quaterniond(pose.rotation.data()).toRotationMatrix();
    int scale_exponent = 0;
    const double scale = std::frexp(pose.scale, &scale_exponent);
    std::uint64_t turn = mixed(mixed(0, scale_exponent), in_steps(scale, kSameTurn));
    for (const double entry : rotation.reshaped())
    {
        turn = mixed(turn, in_steps(entry, kSameTurn));
    }
    // Corners are added with two steps, so that they meet those of neighbours up to 16 times as
    // large.
    for (const double coarser : {1.0, 16.0})
    {
        const int step_log2 = std::ilogb(step_m * coarser);
        for (const auto& position : mesh.positions)
        {
            const Eigen::Vector3d world_m =
                pose.scale * (rotation * Eigen::Vector3d(position.data())) +
                Eigen::Vector3d(pose.translation_m.data());
            std::uint64_t place = mixed(turn, step_log2);
            for (const double x : world_m)
            {
                place = mixed(place, in_steps(x, step_m * coarser));
            }
            if (place <= kept_)
            {
                corners_.push_back({place, static_cast<std::uint32_t>(model), step_log2});
            }
        }
    }
    if (corners_.size() > corners_max_)
    {
        thin_out();
    }
}

void SharedGrids::sort_corners()
{
    std::ranges::sort(corners_);
    corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
}

/// Reduces the corners to half of the maximum, so that as many can follow before the next time.
void SharedGrids::thin_out()
{
    sort_corners();
    if (corners_.size() > corners_max_ / 2)
    {
        kept_ = corners_[corners_max_ / 4].place;
        std::erase_if(corners_, [&](const Corner& corner) { return corner.place > kept_; });
    }
}

std::vector<std::size_t> SharedGrids::first_of_each()
{
    sort_corners();
    std::vector<std::size_t> first(models_);
    std::iota(first.begin(), first.end(), std::size_t{0});
    const auto root = [&](std::size_t model)
    {
        while (first[model] != model)
        {
            model = first[model];
        }
        return model;
    };
    // Number of common corners by two models and step: a common corner may occur with both steps.
    std::map<std::array<std::int64_t, 3>, std::size_t> common;
    const auto meet = [&](const Corner& one, const Corner& other)
    {
        const auto [least, largest] = std::minmax({root(one.model), root(other.model)});
        if (least != largest && ++common[{one.model, other.model, one.step_log2}] == kLeastCommon)
        {
            first[largest] = least;
        }
    };
    for (std::size_t i = 1; i < corners_.size(); ++i)
    {
        for (std::size_t back = 1; back <= std::min(i, kPairsOfEach); ++back)
        {
            if (corners_[i - back].place != corners_[i].place)
            {
                break;
            }
            meet(corners_[i - back], corners_[i]);
        }
    }
    for (std::size_t& model : first)
    {
        model = root(model);
    }
    return first;
}

std::array<double, 3> world_origin_in(const Pose& pose)
{
    const Eigen::Quaterniond rotation(pose.rotation.data());
    const Eigen::Vector3d at =
        rotation.conjugate() * -Eigen::Vector3d(pose.translation_m.data()) / pose.scale;
    return {at.x(), at.y(), at.z()};
}

} // namespace tactus
