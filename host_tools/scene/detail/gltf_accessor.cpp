// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "host_tools/scene/detail/gltf_accessor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace tactus::detail
{

namespace
{

/// Indices are 32-bit, and the largest value is no index.
constexpr std::uint64_t kMaxCount = 0xFFFF'FFFE;

template <typename T>
T value_at(const char* at)
{
    T value{};
    std::memcpy(&value, at, sizeof(value)); // Data may be unaligned.
    return value;
}

} // namespace

void refuse_compressed(const JsonAt& json, std::string_view extension)
{
    json.refuse(fmt::format("is compressed with {}, which is not supported: export it without "
                            "compression, or decode it, for example with gltf-transform copy",
                            extension));
}

GltfAccessor::GltfAccessor(GltfFile& file, std::size_t index)
    : json_(file.root().at("accessors").at(index))
    , component_(component_of(json_.at("componentType")))
    , count_(json_.at("count").whole(kMaxCount))
{
    const std::string& type = json_.at("type").text();
    if (type != "SCALAR" && type != "VEC3" && type != "VEC4")
    {
        json_.at("type").refuse("must be SCALAR for indices and VEC3 for positions");
    }
    width_ = type == "VEC4" ? 4 : type == "VEC3" ? 3 : 1;
    if (count_ == 0)
    {
        json_.at("count").refuse("must be at least 1");
    }
    if (const auto normalized = json_.find("normalized"))
    {
        is_normalized_ = normalized->boolean();
    }
    read_base(file);
    read_sparse(file);
}

GltfAccessor::Component GltfAccessor::component_of(const JsonAt& json)
{
    const std::uint64_t code = json.whole(0xFFFF);
    if ((code < 5120 || code > 5126 || code == 5124) && code != 5130)
    {
        json.refuse(fmt::format("is {}; must be 5120 to 5123, 5125, 5126 or 5130", code));
    }
    return static_cast<Component>(code);
}

std::size_t GltfAccessor::bytes_of(Component component)
{
    switch (component)
    {
    case Component::i8:
    case Component::u8:
        return 1;
    case Component::i16:
    case Component::u16:
        return 2;
    case Component::f64:
        return 8;
    default:
        return 4;
    }
}

/// Bytes from the byteOffset of `user` to the end of its bufferView. Sets `stride` to the view's
/// byteStride, if it has one.
std::string_view GltfAccessor::view_of(GltfFile& file, const JsonAt& user, std::size_t& stride)
{
    const JsonAt root = file.root();
    const std::size_t index =
        user.at("bufferView").index_below(root.size_of("bufferViews"), "bufferViews");
    const JsonAt view = root.at("bufferViews").at(index);
    const std::size_t number = view.at("buffer").index_below(root.size_of("buffers"), "buffers");
    const auto extensions = view.find("extensions");
    for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"})
    {
        if (extensions && extensions->find(name) &&
            (file.requires_extension(name) || !file.has_buffer(number)))
        {
            refuse_compressed(view, name);
        }
    }
    const std::string_view bytes = file.buffer(number);
    const auto offset_of = [](const JsonAt& json)
    {
        const auto offset = json.find("byteOffset");
        return offset ? offset->whole(kMaxGltfBytes) : 0;
    };
    const std::uint64_t begin = offset_of(view);
    const std::uint64_t length = view.at("byteLength").whole(kMaxGltfBytes);
    if (begin > bytes.size() || length > bytes.size() - begin)
    {
        view.refuse(fmt::format("ends at byte {}, but its buffer has {} bytes", begin + length,
                                bytes.size()));
    }
    const std::uint64_t inner = offset_of(user);
    if (inner > length)
    {
        user.refuse(
            fmt::format("begins at byte {}, but its bufferView has {} bytes", inner, length));
    }
    if (const auto given = view.find("byteStride"))
    {
        stride = given->whole(252);
    }
    return bytes.substr(begin + inner, length - inner);
}

void GltfAccessor::read_base(GltfFile& file)
{
    if (!json_.find("bufferView"))
    {
        return;
    }
    const std::size_t size = width_ * bytes_of(component_);
    stride_ = size;
    base_ = view_of(file, json_, stride_);
    if (stride_ < size)
    {
        json_.refuse(fmt::format("has elements of {} bytes, {} bytes apart", size, stride_));
    }
    if (base_.size() < size || (base_.size() - size) / stride_ < count_ - 1)
    {
        json_.refuse(fmt::format("has {} elements, {} bytes apart, in {} bytes", count_, stride_,
                                 base_.size()));
    }
}

void GltfAccessor::read_sparse(GltfFile& file)
{
    const auto sparse = json_.find("sparse");
    if (!sparse)
    {
        return;
    }
    sparse_count_ = sparse->at("count").whole(count_);
    const JsonAt indices = sparse->at("indices");
    const JsonAt values = sparse->at("values");
    sparse_component_ = component_of(indices.at("componentType"));
    if (sparse_component_ != Component::u8 && sparse_component_ != Component::u16 &&
        sparse_component_ != Component::u32)
    {
        indices.refuse("must be unsigned whole numbers");
    }
    std::size_t unused = 0;
    sparse_indices_ = view_of(file, indices, unused);
    sparse_values_ = view_of(file, values, unused);
    const std::size_t index_bytes = bytes_of(sparse_component_);
    if (sparse_indices_.size() / index_bytes < sparse_count_ ||
        sparse_values_.size() / (width_ * bytes_of(component_)) < sparse_count_)
    {
        sparse->refuse(fmt::format("has {} elements in too few bytes", sparse_count_));
    }
    for (std::size_t i = 0; i < sparse_count_; ++i)
    {
        const char* at = sparse_indices_.data() + i * index_bytes;
        const std::uint32_t index = whole_at(at, sparse_component_);
        if (index >= count_ || (i > 0 && index <= whole_at(at - index_bytes, sparse_component_)))
        {
            indices.refuse(
                fmt::format("[{}] is {}; indices must increase and be below {}", i, index, count_));
        }
    }
}

void GltfAccessor::require_indices() const
{
    const bool is_unsigned =
        component_ == Component::u8 || component_ == Component::u16 || component_ == Component::u32;
    if (width_ != 1 || !is_unsigned || is_normalized_)
    {
        json_.refuse(
            "can't be indices: indices must be SCALAR of componentType 5121, 5123 or 5125");
    }
}

void GltfAccessor::require_positions(const GltfFile& file) const
{
    if (width_ != 3 || component_ == Component::u32)
    {
        json_.refuse("can't be positions: positions must be VEC3 of componentType 5126");
    }
    const bool is_float = component_ == Component::f32 || component_ == Component::f64;
    if (!is_float && !file.requires_extension("KHR_mesh_quantization"))
    {
        json_.refuse("has integer positions without requiring KHR_mesh_quantization");
    }
    if (is_float && is_normalized_)
    {
        json_.refuse("has normalized floats");
    }
}

void GltfAccessor::require_width(std::size_t width) const
{
    if (width_ != width)
    {
        json_.refuse(fmt::format("has {} numbers an element; {} are needed", width_, width));
    }
}

std::uint32_t GltfAccessor::whole_at(const char* at, Component component)
{
    switch (component)
    {
    case Component::u8:
        return value_at<std::uint8_t>(at);
    case Component::u16:
        return value_at<std::uint16_t>(at);
    default:
        return value_at<std::uint32_t>(at);
    }
}

/// Bytes of element `i`; null if the element is 0.
const char* GltfAccessor::element(std::size_t i) const
{
    const std::size_t index_bytes = bytes_of(sparse_component_);
    std::size_t first = 0;
    std::size_t last = sparse_count_;
    while (first < last)
    {
        const std::size_t middle = first + (last - first) / 2;
        const std::uint32_t index =
            whole_at(sparse_indices_.data() + middle * index_bytes, sparse_component_);
        if (index == i)
        {
            return sparse_values_.data() + middle * width_ * bytes_of(component_);
        }
        (index < i ? first : last) = index < i ? middle + 1 : middle;
    }
    return base_.empty() ? nullptr : base_.data() + i * stride_;
}

std::uint32_t GltfAccessor::index(std::size_t i) const
{
    const char* at = element(i);
    return at == nullptr ? 0 : whole_at(at, component_);
}

/// Decodes one number. Normalized signed integers are -1 to 1; the least integer also becomes -1.
double GltfAccessor::number_at(const char* at) const
{
    const auto scaled = [this](double value, double largest)
    { return is_normalized_ ? std::max(value / largest, -1.0) : value; };
    switch (component_)
    {
    case Component::i8:
        return scaled(value_at<std::int8_t>(at), 127.0);
    case Component::u8:
        return scaled(value_at<std::uint8_t>(at), 255.0);
    case Component::i16:
        return scaled(value_at<std::int16_t>(at), 32'767.0);
    case Component::u16:
        return scaled(value_at<std::uint16_t>(at), 65'535.0);
    case Component::u32:
        return scaled(value_at<std::uint32_t>(at), 4'294'967'295.0);
    case Component::f64:
        return value_at<double>(at);
    default:
        return static_cast<double>(value_at<float>(at));
    }
}

void GltfAccessor::read_numbers(std::size_t i, std::span<double> numbers) const
{
    const char* at = element(i);
    for (std::size_t axis = 0; axis < numbers.size() && at != nullptr; ++axis)
    {
        numbers[axis] = number_at(at + axis * bytes_of(component_));
        if (!std::isfinite(numbers[axis]))
        {
            json_.refuse(fmt::format("has element {}: {} is {}; must be finite", i, "xyzw"[axis],
                                     numbers[axis]));
        }
    }
}

} // namespace tactus::detail
