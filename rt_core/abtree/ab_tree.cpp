// SPDX-License-Identifier: Apache-2.0
// Copyright the Tactus authors.
#include "rt_core/abtree/ab_tree.hpp"

#include "rt_core/base/assert.hpp"
#include "rt_core/base/static_vector.hpp"

#include <bit>

namespace tactus
{

namespace
{

/// Largest number of faces with which two sibling cells merge into one block. A block splits beyond
/// 16; the gap keeps a face that is added and removed repeatedly from splitting it each time.
constexpr std::uint32_t kMergeFaces = 10;
static_assert(kMergeFaces < kBlockFaces);

/// Bit position of the highest octal digit in which two different paths differ.
std::uint32_t digit_shift(std::uint64_t a, std::uint64_t b) noexcept
{
    TACTUS_ASSERT(a != b);
    const auto bit = static_cast<std::uint32_t>(63 - std::countl_zero(a ^ b));
    return bit / 3 * 3;
}

} // namespace

AbTree::AbTree(TreePool& pool, ModelId owner, const TreeCapacities& least, float quantum_m,
               const Kernels& kernels) noexcept
    : pool_(&pool)
    , quantum_m_(quantum_m)
    , kernels_(&kernels)
    , blocks_(pool.blocks())
    , sides_(pool.sides())
    , nodes_(pool.nodes())
    , prims_(pool.prims())
    , owner_(static_cast<std::uint8_t>(owner.value))
    , share_(pool.promise(least))
{
    static_assert(TreePool::kMostBlocks * kBlockFaces <= kUnplaced);
    static_assert(kMaxPoolFaces <= kLastUnplaced);
    TACTUS_ASSERT(owner.value < kMaxModels);
    dirty_heads_.fill(kNoNode);
}

void AbTree::insert(const ChangedFace& face) noexcept
{
    TACTUS_ASSERT(!face.face.is_none());
    TACTUS_ASSERT(face.prim.value < prims_.size());
    TACTUS_ASSERT(prims_[face.prim.value].leaf == kNoLeaf);
    prims_[face.prim.value] = Prim{face.face, face.bucket, kNoLeaf};
    if (has_reserve())
    {
        place(face);
    }
    else
    {
        keep_unplaced(face.prim);
    }
}

void AbTree::move_corner(PrimId prim, std::uint32_t corner, const Vec3f& position_m,
                         ErrorCode error) noexcept
{
    TACTUS_ASSERT(corner < 3);
    const std::uint32_t leaf = leaf_of(prim);
    if (leaf == kNoLeaf)
    {
        return;
    }
    const std::uint32_t block = leaf / kBlockFaces;
    const std::uint32_t lane = leaf % kBlockFaces;
    if (move_corner_in_block(blocks_[block], sides_[block], lane, corner, position_m, error))
    {
        mark(TreeRef::to_block(block));
        return;
    }
    ChangedFace face = describe(block, lane);
    face.corners_m[corner] = position_m;
    face.error = error;
    face.is_outdated = false;
    update(face);
}

void AbTree::outdate(std::uint32_t block, std::uint32_t lanes) noexcept
{
    TACTUS_ASSERT(is_block_in_use(block));
    TACTUS_ASSERT((lanes & ~std::uint32_t{blocks_[block].faces}) == 0);
    BlockSide& side = sides_[block];
    if ((lanes & ~std::uint32_t{side.outdated}) != 0)
    {
        side.outdated = static_cast<std::uint16_t>(side.outdated | lanes);
        side.coarse = static_cast<std::uint16_t>(side.coarse | lanes);
        mark(TreeRef::to_block(block));
    }
}

void AbTree::remove(PrimId prim) noexcept
{
    TACTUS_ASSERT(!face_of(prim).is_none());
    if (leaf_of(prim) == kNoLeaf)
    {
        drop_unplaced(prim);
    }
    else
    {
        take_out(prim);
    }
    prims_[prim.value] = Prim{};
}

PrimId AbTree::any_prim() const noexcept
{
    if (!is_complete())
    {
        return PrimId{first_unplaced_};
    }
    TreeRef ref = root_;
    while (!ref.is_none() && !ref.is_block())
    {
        const AbNode& node = nodes_[ref.index()];
        ref = node.children[static_cast<std::size_t>(std::countr_zero(node.mask))];
    }
    return ref.is_none()
               ? PrimId{}
               : sides_[ref.index()]
                     .prims[static_cast<std::size_t>(std::countr_zero(blocks_[ref.index()].faces))];
}

void AbTree::place(const ChangedFace& face) noexcept
{
    if (root_.is_none())
    {
        const std::uint32_t block = take_block();
        root_ = TreeRef::to_block(block);
        const bool added = try_add(block, face);
        TACTUS_ASSERT(added);
        return;
    }
    insert_below(root_, face, path_of(face.face, face.bucket));
}

void AbTree::insert_below(TreeRef ref, const ChangedFace& face, std::uint64_t path) noexcept
{
    for (std::uint32_t level = 0; level <= kTreeLevels; ++level)
    {
        if (ref.is_block())
        {
            insert_into_block(ref.index(), face);
            return;
        }
        const AbNode& node = nodes_[ref.index()];
        if (!node.holds(path))
        {
            insert_beside(ref.index(), face, path);
            return;
        }
        const std::uint32_t child = node.child_of(node.digit_of(path));
        if (child == AbNode::kNoChild)
        {
            insert_at_free_digit(ref.index(), face, node.digit_of(path));
            return;
        }
        ref = node.children[child];
    }
    TACTUS_ASSERT(false && "a path has no more digits than levels");
}

/// Inserts a face whose path does not lead below `node`: a new node takes `node` and a block with
/// the face as children.
void AbTree::insert_beside(std::uint32_t node, const ChangedFace& face, std::uint64_t path) noexcept
{
    const std::uint64_t prefix = nodes_[node].prefix;
    const std::uint32_t above = take_node(digit_shift(path, prefix), path);
    const std::uint32_t block = take_block();
    replace(TreeRef::to_node(node), TreeRef::to_node(above));
    attach(above, {nodes_[above].digit_of(prefix), 1}, TreeRef::to_node(node));
    attach(above, {nodes_[above].digit_of(path), 1}, TreeRef::to_block(block));
    const bool added = try_add(block, face);
    TACTUS_ASSERT(added);
}

/// Inserts a face at a digit of the node without a child. If possible, a neighbouring block is
/// widened to the binary cell that holds both.
void AbTree::insert_at_free_digit(std::uint32_t node_index, const ChangedFace& face,
                                  std::uint32_t digit) noexcept
{
    AbNode& node = nodes_[node_index];
    TACTUS_ASSERT(node.child_of(digit) == AbNode::kNoChild);
    for (std::uint32_t width = 2; width <= kNodeChildren; width *= 2)
    {
        const DigitRange cell{digit & ~(width - 1), width};
        const std::uint32_t beside = node.only_child_in(cell);
        if (beside == AbNode::kNoChild)
        {
            continue;
        }
        const bool is_block = beside != AbNode::kSeveral && node.children[beside].is_block();
        if (!is_block || !try_add(node.children[beside].index(), face))
        {
            break;
        }
        node.assign(cell, beside);
        return;
    }
    const std::uint32_t block = take_block();
    attach(node_index, {digit, 1}, TreeRef::to_block(block));
    const bool added = try_add(block, face);
    TACTUS_ASSERT(added);
}

void AbTree::insert_into_block(std::uint32_t block, const ChangedFace& face) noexcept
{
    if (!try_add(block, face))
    {
        split_block(block, face);
    }
}

void AbTree::update(const ChangedFace& face) noexcept
{
    const std::uint32_t leaf = prims_[face.prim.value].leaf;
    const std::uint32_t block = leaf / kBlockFaces;
    remove_from_block(blocks_[block], sides_[block], leaf % kBlockFaces);
    if (!try_add(block, face))
    {
        reinsert(block, face);
    }
}

/// Inserts a face that was removed from `block` because no vertex row was free for its moved
/// corner. Without a reserve in the pool the face stays unplaced.
void AbTree::reinsert(std::uint32_t block, const ChangedFace& face) noexcept
{
    prims_[face.prim.value].leaf = kNoLeaf;
    mark(TreeRef::to_block(block));
    if (has_reserve())
    {
        split_block(block, face);
        return;
    }
    keep_unplaced(face.prim);
    if (blocks_[block].faces == 0)
    {
        drop_empty(block);
    }
}

void AbTree::take_out(PrimId prim) noexcept
{
    const std::uint32_t leaf = prims_[prim.value].leaf;
    const std::uint32_t block = leaf / kBlockFaces;
    remove_from_block(blocks_[block], sides_[block], leaf % kBlockFaces);
    if (blocks_[block].faces != 0)
    {
        mark(TreeRef::to_block(block));
        merge_upward(block);
        return;
    }
    drop_empty(block);
}

void AbTree::drop_empty(std::uint32_t block) noexcept
{
    const std::uint32_t parent = sides_[block].parent;
    const std::uint32_t child = sides_[block].child;
    free_block(block);
    if (parent == kNoNode)
    {
        root_ = TreeRef{};
        return;
    }
    detach(parent, child);
    if (nodes_[parent].child_count() == 1)
    {
        hoist_only_child(parent);
    }
}

bool AbTree::try_add(std::uint32_t block, const ChangedFace& face) noexcept
{
    const std::uint32_t lane = add_to_block(blocks_[block], sides_[block], face);
    if (lane == kBlockFaces)
    {
        return false;
    }
    prims_[face.prim.value].leaf = block * kBlockFaces + lane;
    mark(TreeRef::to_block(block));
    return true;
}

/// Splits the block into smaller binary cells until the face fits into the cell of its path. Each
/// round removes at least one face from that cell, so there are at most as many rounds as faces.
void AbTree::split_block(std::uint32_t block, const ChangedFace& face) noexcept
{
    const std::uint64_t path = path_of(face.face, face.bucket);
    for (std::uint32_t round = 0; round <= kBlockFaces; ++round)
    {
        std::array<std::uint64_t, kBlockFaces> paths; // NOLINT: written where it is read.
        std::uint64_t differing = 0;
        for (std::uint32_t lanes = blocks_[block].faces; lanes != 0; lanes &= lanes - 1)
        {
            const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
            const Prim& prim = prims_[sides_[block].prims[lane].value];
            paths[lane] = path_of(prim.face, prim.bucket);
            differing |= paths[lane] ^ path;
        }
        TACTUS_ASSERT(differing != 0);
        const auto bit = static_cast<std::uint32_t>(63 - std::countl_zero(differing));
        std::uint32_t apart = 0;
        for (std::uint32_t lanes = blocks_[block].faces; lanes != 0; lanes &= lanes - 1)
        {
            const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
            apart |= (((paths[lane] ^ path) >> bit) & 1U) != 0 ? 1U << lane : 0U;
        }
        block = part(block, bit, path, apart);
        if (try_add(block, face))
        {
            return;
        }
    }
    TACTUS_ASSERT(false && "a single face fits a block");
}

/// Halves the block's cell by a bit of the paths, above which they all agree with `path`. The lanes
/// `apart` differ from `path` in that bit. Returns the block of the half with `path`.
std::uint32_t AbTree::part(std::uint32_t block, std::uint32_t bit, std::uint64_t path,
                           std::uint32_t apart) noexcept
{
    TACTUS_ASSERT(apart != 0);
    const std::uint32_t shift = bit / 3 * 3;
    const std::uint32_t width = 1U << (bit - shift);
    const std::uint32_t parent = node_above(block, shift, path);
    const std::uint32_t digit = nodes_[parent].digit_of(path) & ~(width - 1);
    const DigitRange near{digit, width};
    const DigitRange far{digit ^ width, width};
    const std::uint32_t together = blocks_[block].faces & ~apart;
    const bool stays = std::popcount(apart) <= std::popcount(together);
    const std::uint32_t moved = stays ? apart : together;
    const std::uint32_t other = take_block();
    halve_block(blocks_[block], sides_[block], moved, blocks_[other], sides_[other]);
    for (const std::uint32_t half : {block, other})
    {
        for (std::uint32_t lane = 0; lane < face_count(blocks_[half]); ++lane)
        {
            prims_[sides_[half].prims[lane].value].leaf = half * kBlockFaces + lane;
        }
    }
    const std::uint32_t child = sides_[block].child;
    nodes_[parent].assign(nodes_[parent].range_of(child), AbNode::kNoChild);
    nodes_[parent].assign(stays ? near : far, child);
    mark(TreeRef::to_block(block));
    attach(parent, stays ? far : near, TreeRef::to_block(other));
    return stays ? block : other;
}

/// Returns the node of the octal digit at `shift` above the block: the block's parent, or a new
/// node between both. All paths of the block must agree with `path` above that digit.
std::uint32_t AbTree::node_above(std::uint32_t block, std::uint32_t shift,
                                 std::uint64_t path) noexcept
{
    const std::uint32_t parent = sides_[block].parent;
    if (parent != kNoNode && nodes_[parent].shift == shift)
    {
        return parent;
    }
    TACTUS_ASSERT(parent == kNoNode || nodes_[parent].shift > shift);
    const std::uint32_t child = sides_[block].child;
    const std::uint32_t above = take_node(shift, path);
    if (parent == kNoNode)
    {
        root_ = TreeRef::to_node(above);
    }
    else
    {
        AbNode& node = nodes_[parent];
        node.assign(node.range_of(child), AbNode::kNoChild);
        node.assign({node.digit_of(path), 1}, child);
        node.children[child] = TreeRef::to_node(above);
        set_link(TreeRef::to_node(above), parent, child);
        mark(TreeRef::to_node(parent));
    }
    attach(above, {nodes_[above].digit_of(path), 1}, TreeRef::to_block(block));
    return above;
}

/// Merges a block that lost a face with its sibling cell, repeatedly, while both have at most
/// kMergeFaces faces together.
void AbTree::merge_upward(std::uint32_t block) noexcept
{
    while (sides_[block].parent != kNoNode && face_count(blocks_[block]) <= kMergeFaces)
    {
        const std::uint32_t parent = sides_[block].parent;
        AbNode& node = nodes_[parent];
        const DigitRange own = node.range_of(sides_[block].child);
        const DigitRange sibling{own.first ^ own.width, own.width};
        const std::uint32_t other = node.only_child_in(sibling);
        if (other == AbNode::kSeveral)
        {
            return;
        }
        if (other != AbNode::kNoChild)
        {
            const TreeRef ref = node.children[other];
            if (!ref.is_block() || !try_absorb(block, ref.index()))
            {
                return;
            }
            detach(parent, other);
        }
        node.assign(sibling, sides_[block].child);
        if (node.child_count() == 1)
        {
            hoist_only_child(parent);
        }
    }
}

/// Moves all faces of `other` into `block` and frees it. False, with nothing changed, if they do
/// not fit.
bool AbTree::try_absorb(std::uint32_t block, std::uint32_t other) noexcept
{
    if (face_count(blocks_[block]) + face_count(blocks_[other]) > kMergeFaces)
    {
        return false;
    }
    BlockGeometry geometry = blocks_[block];
    BlockSide side = sides_[block];
    std::array<std::uint32_t, kBlockFaces> lanes{};
    for (std::uint32_t used = blocks_[other].faces; used != 0; used &= used - 1)
    {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(used));
        lanes[lane] = add_to_block(geometry, side, describe(other, lane));
        if (lanes[lane] == kBlockFaces)
        {
            return false;
        }
    }
    for (std::uint32_t used = blocks_[other].faces; used != 0; used &= used - 1)
    {
        const auto lane = static_cast<std::uint32_t>(std::countr_zero(used));
        prims_[sides_[other].prims[lane].value].leaf = block * kBlockFaces + lanes[lane];
    }
    blocks_[block] = geometry;
    sides_[block] = side;
    mark(TreeRef::to_block(block));
    free_block(other);
    return true;
}

void AbTree::hoist_only_child(std::uint32_t node) noexcept
{
    TACTUS_ASSERT(nodes_[node].child_count() == 1);
    const auto child = static_cast<std::uint32_t>(std::countr_zero(nodes_[node].mask));
    const TreeRef ref = nodes_[node].children[child];
    replace(TreeRef::to_node(node), ref);
    free_node(node);
    mark(ref);
}

void AbTree::attach(std::uint32_t node_index, DigitRange digits, TreeRef ref) noexcept
{
    AbNode& node = nodes_[node_index];
    const auto child = static_cast<std::uint32_t>(std::countr_one(node.mask));
    TACTUS_ASSERT(child < kNodeChildren);
    TACTUS_ASSERT(std::has_single_bit(digits.width));
    TACTUS_ASSERT(digits.first % digits.width == 0);
    node.mask = static_cast<std::uint8_t>(node.mask | (1U << child));
    node.children[child] = ref;
    node.volumes.set(child, Aabb{});
    node.set_below(child, {});
    TACTUS_ASSERT(node.only_child_in(digits) == AbNode::kNoChild);
    node.assign(digits, child);
    set_link(ref, node_index, child);
    mark(ref);
    mark(TreeRef::to_node(node_index));
}

void AbTree::detach(std::uint32_t node_index, std::uint32_t child) noexcept
{
    AbNode& node = nodes_[node_index];
    TACTUS_ASSERT(((std::uint32_t{node.mask} >> child) & 1U) != 0);
    node.mask = static_cast<std::uint8_t>(node.mask & ~(1U << child));
    node.children[child] = TreeRef{};
    node.set_below(child, {});
    node.assign(node.range_of(child), AbNode::kNoChild);
    mark(TreeRef::to_node(node_index));
}

/// Puts `new_ref` in the place of the node `old_ref`: as the same child of its parent, or as the
/// root.
void AbTree::replace(TreeRef old_ref, TreeRef new_ref) noexcept
{
    TACTUS_ASSERT(!old_ref.is_block());
    TACTUS_ASSERT(!new_ref.is_none());
    const std::uint32_t parent = nodes_[old_ref.index()].parent;
    const std::uint32_t child = nodes_[old_ref.index()].child;
    set_link(new_ref, parent, child);
    if (parent == kNoNode)
    {
        root_ = new_ref;
        return;
    }
    nodes_[parent].children[child] = new_ref;
    mark(TreeRef::to_node(parent));
}

void AbTree::set_link(TreeRef ref, std::uint32_t parent, std::uint32_t child) noexcept
{
    const auto child_byte = static_cast<std::uint8_t>(child);
    if (ref.is_block())
    {
        sides_[ref.index()].parent = parent;
        sides_[ref.index()].child = child_byte;
    }
    else
    {
        nodes_[ref.index()].parent = parent;
        nodes_[ref.index()].child = child_byte;
    }
}

ChangedFace AbTree::describe(std::uint32_t block, std::uint32_t lane) const noexcept
{
    TACTUS_ASSERT(((std::uint32_t{blocks_[block].faces} >> lane) & 1U) != 0);
    const PrimId prim = sides_[block].prims[lane];
    const Prim& known = prims_[prim.value];
    return {prim,
            known.face,
            known.bucket,
            sides_[block].errors[lane],
            block_triangle(blocks_[block], lane),
            ((std::uint32_t{sides_[block].outdated} >> lane) & 1U) != 0};
}

std::uint64_t AbTree::path_of(FaceId face, std::uint32_t bucket) noexcept
{
    // Multiplying by an odd number is a bijection, so paths of different faces differ. It spreads
    // neighbouring ids over the upper bits, which are tested first.
    const std::uint32_t mixed = face.value * 0x9E37'79B9U;
    // The bucket begins on a digit. Otherwise its lowest bit would share a digit with the id's, and
    // every second node would be half empty.
    return (std::uint64_t{bucket} << 33U) | (std::uint64_t{mixed} << 1U);
}

bool AbTree::has_room_for(std::uint32_t changed_faces) const noexcept
{
    // Ordinarily one changed face splits one block; the reserve covers the worst case.
    return pool_->has_room_for(share_, changed_faces + kReserve);
}

std::uint32_t AbTree::take_block() noexcept
{
    ++blocks_used_;
    blocks_used_max_ = blocks_used_ > blocks_used_max_ ? blocks_used_ : blocks_used_max_;
    return pool_->take_block(share_, {owner_});
}

std::uint32_t AbTree::take_node(std::uint32_t shift, std::uint64_t prefix) noexcept
{
    const std::uint32_t index = pool_->take_node(share_, {owner_});
    nodes_[index].shift = static_cast<std::uint8_t>(shift);
    nodes_[index].prefix = prefix;
    ++nodes_used_;
    nodes_used_max_ = nodes_used_ > nodes_used_max_ ? nodes_used_ : nodes_used_max_;
    return index;
}

void AbTree::free_block(std::uint32_t block) noexcept
{
    TACTUS_ASSERT(is_block_in_use(block));
    last_change_ = pool_->next_change();
    sides_[block].in_use = false;
    blocks_[block].faces = 0;
    --blocks_used_;
    if (!sides_[block].is_marked)
    {
        pool_->give_back_block(share_, block);
    }
}

void AbTree::free_node(std::uint32_t node) noexcept
{
    TACTUS_ASSERT(is_node_in_use(node));
    nodes_[node].in_use = false;
    --nodes_used_;
    if (!nodes_[node].is_marked)
    {
        pool_->give_back_node(share_, node);
    }
}

void AbTree::keep_unplaced(PrimId prim) noexcept
{
    TACTUS_ASSERT(prims_[prim.value].leaf == kNoLeaf);
    prims_[prim.value].leaf = kUnplaced | std::exchange(first_unplaced_, prim.value);
}

void AbTree::drop_unplaced(PrimId prim) noexcept
{
    TACTUS_ASSERT(is_unplaced(prim));
    const std::uint32_t after = prims_[prim.value].leaf & ~kUnplaced;
    if (first_unplaced_ == prim.value)
    {
        first_unplaced_ = after;
        return;
    }
    std::uint32_t before = first_unplaced_;
    while ((prims_[before].leaf & ~kUnplaced) != prim.value)
    {
        before = prims_[before].leaf & ~kUnplaced;
        TACTUS_ASSERT(before != kLastUnplaced);
    }
    prims_[before].leaf = kUnplaced | after;
}

/// Numbers a change of the tree, and adds the block or node to the list that waits for refit unless
/// it is listed.
void AbTree::mark(TreeRef ref) noexcept
{
    last_change_ = pool_->next_change();
    const std::uint32_t index = ref.index();
    if (ref.is_block())
    {
        BlockSide& side = sides_[index];
        if (!side.is_marked)
        {
            side.is_marked = true;
            side.link = std::exchange(marked_block_, index);
        }
        return;
    }
    AbNode& node = nodes_[index];
    if (!node.is_marked)
    {
        node.is_marked = true;
        node.link = std::exchange(marked_node_, index);
    }
}

} // namespace tactus
