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

/// Faces of a model identified by position in the source, whose order is not that of FaceIds. Faces
/// with the same three corners share a name, the lowest of their places.
class FaceNames
{
public:
    explicit FaceNames(const std::vector<Face>& faces);

    /// Name of a face of the source.
    [[nodiscard]] std::uint32_t of(std::uint32_t source) const { return names_[source]; }
    /// Name of an active face; empty if it is not active or not a face of the source.
    [[nodiscard]] std::optional<std::uint32_t> of(const Model& model, FaceId face) const;

private:
    std::map<Face, std::uint32_t> by_corners_; ///< Names by corners in ascending order.
    std::vector<std::uint32_t> names_;
};

} // namespace tactus::test
