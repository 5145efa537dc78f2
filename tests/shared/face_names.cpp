// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "tests/shared/face_names.hpp"

#include <algorithm>

namespace tactus::test
{

namespace
{

Face in_order(Face face)
{
    std::sort(face.begin(), face.end());
    return face;
}

} // namespace

FaceNames::FaceNames(const std::vector<Face>& faces)
{
    for (std::uint32_t i = 0; i < faces.size(); ++i)
    {
        names_.push_back(by_corners_.emplace(in_order(faces[i]), i).first->second);
    }
}

std::optional<std::uint32_t> FaceNames::of(const Model& model, FaceId face) const
{
    if (face.is_none() || face.value >= model.header.counts().face_ids())
    {
        return std::nullopt;
    }
    const PrimId prim = model.forest.find(face);
    if (prim.is_none())
    {
        return std::nullopt;
    }
    const auto found = by_corners_.find(in_order(model.forest.corners_of(prim)));
    return found == by_corners_.end() ? std::nullopt : std::optional(found->second);
}

} // namespace tactus::test
