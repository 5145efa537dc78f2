// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/math/infinity.hpp"
#include "rt_core/math/vec3.hpp"
#include "rt_core/records/contact.hpp"
#include "rt_core/spm/header.hpp"
#include "transport/base/refusal.hpp"
#include "transport/served_model.hpp"

#include <chrono>
#include <filesystem>
#include <memory>
#include <span>

// Thread: any. Several threads may ask one model at once.
namespace tactus
{

/// From a point to the surface of a model's source mesh, in metres of the source's frame.
struct PointDistance
{
    double lower_m{0.0};           ///< The distance is at least this
    double upper_m{kInfinity};     ///< and at most this: the two differ by rounding.
    Vec3 nearest_m{0.0, 0.0, 0.0}; ///< Of the surface; where several points are, one of them.
    Side side{Side::unsigned_distance};
};

/// The whole of a model, refined to its source mesh: distances without hands, frames and time.
class StaticModel
{
public:
    /// Of a model's file. Refused when it can't be read, is damaged or has no room in memory. About
    /// 200 bytes and two microseconds a face.
    [[nodiscard]] static Result<std::unique_ptr<StaticModel>, Refusal>
    open(const std::filesystem::path& path);
    /// The same of a model that anybody serves; refused as well when nothing more came for
    /// `patience`. The link is not used afterwards.
    [[nodiscard]] static Result<std::unique_ptr<StaticModel>, Refusal>
    load(ServedModel served, std::chrono::milliseconds patience = std::chrono::seconds(10));

    ~StaticModel();
    StaticModel(const StaticModel&) = delete;
    StaticModel& operator=(const StaticModel&) = delete;
    StaticModel(StaticModel&&) = delete;
    StaticModel& operator=(StaticModel&&) = delete;

    [[nodiscard]] const ModelHeader& header() const noexcept;

    /// The answer to each point, of the source's frame; as many `answers` as points. Refused, with
    /// nothing written, when one is not finite or farther than 2^36 quanta from the model's corner,
    /// some 4,000 to a million diagonals. Some microseconds a point, less where points that follow
    /// one another are near.
    [[nodiscard]] Result<Done, Refusal> distances(std::span<const Vec3> points_m,
                                                  std::span<PointDistance> answers) const;

private:
    struct Parts;

    explicit StaticModel(std::unique_ptr<Parts> parts);

    std::unique_ptr<Parts> parts_;
};

} // namespace tactus
