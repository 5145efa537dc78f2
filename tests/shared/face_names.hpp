// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/frame/model.hpp"
#include "tests/shared/brute_force.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace tactus::test
{

/// Faces of a model told by where they are: the source's faces, whose order isn't that of FaceIds.
/// Faces with the same three corners share a name, the lowest of their places in the source.
class FaceNames
{
public:
    explicit FaceNames(const std::vector<Face>& faces);

    /// Of a face of the source.
    [[nodiscard]] std::uint32_t of(std::uint32_t source) const { return names_[source]; }
    /// Of an active face; none when it is not active or no face of the source.
    [[nodiscard]] std::optional<std::uint32_t> of(const Model& model, FaceId face) const;

private:
    std::map<Face, std::uint32_t> by_corners_; ///< Corners in ascending order.
    std::vector<std::uint32_t> names_;
};

} // namespace tactus::test
