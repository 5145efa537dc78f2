// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#pragma once

#include "rt_core/base/result.hpp"
#include "rt_core/limits.hpp"
#include "rt_core/records/surface_edit.hpp"
#include "rt_core/spm/header.hpp"
#include "transport/base/refusal.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

// Any thread except the haptic one: values that allocate.
namespace tactus
{

/// Largest number of faces that one part of a sum of edits removes, and that it adds. Frames take
/// the sum in edits of kMaxEditFaces.
inline constexpr std::uint32_t kMaxSumFaces = 1'024;

/// A SurfaceEdit that owns its faces, for a model that its holder knows.
struct EditContent
{
    std::uint32_t revision{0};
    std::vector<FaceId> removed;
    std::vector<AddedFace> added;
    Aabb removed_m; ///< SurfaceEdit::removed_m.

    bool operator==(const EditContent&) const = default;

    /// View for a frame; valid as long as this object and unchanged.
    [[nodiscard]] SurfaceEdit view(ModelId model) const noexcept
    {
        return {model, revision, removed, added, removed_m};
    }
};

/// Size of the largest coded edit, in bytes: all faces of a sum's part, without shared vertices.
inline constexpr std::size_t kMaxCodedEditBytes =
    10 + kMaxSumFaces * 4 + 24 + kMaxSumFaces * 3 * 9 + kMaxSumFaces * 14;

/// Codes an edit of the model into `coded`. The edit must be one that decode_edit() accepts
/// (asserted for its vertices). Each vertex is coded once, as three whole numbers of quanta.
///
/// The bytes, little-endian: revision u32; numbers of removed faces, vertices and added faces u16
/// each; removed faces u32 each; with a removed source face the box, six f32; vertices, u24 x 3
/// each, in the order of their first use; added faces: slot u32, bucket u32, vertices u16 x 3.
void encode_edit(const EditContent& edit, const ModelHeader& header, std::vector<std::byte>& coded);

/// Decodes an untrusted edit. Refused in one line are:
/// - bytes that are missing or left over, and more than `most` faces of a kind,
/// - ids and slots that the model can't have or that occur twice,
/// - a bucket of more than 31 bits, and a box that is empty or not finite,
/// - vertices outside the model's box.
[[nodiscard]] Result<EditContent, Refusal> decode_edit(std::span<const std::byte> coded,
                                                       const ModelHeader& header,
                                                       std::size_t most = kMaxEditFaces);

} // namespace tactus
