// SPDX-FileCopyrightText: the nestgrid authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Elements of a grid whose type the library does not know.
//
// A handle stands for one element while a walk is at it. Elements that are trivially copyable and
// at most 48 bytes large lie in the handle itself. All others lie in the family they belong to
// (hierarchy.hpp), and the handle points there: it is valid as long as the walk is below the
// element's father. Elements that are to outlive the walk are copied into a list.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

#include <nestgrid/error.hpp>

namespace nestgrid {

/// One element, or where it lies.
struct Handle {
    static constexpr std::size_t size = 48;
    static constexpr std::size_t alignment = 8;
    alignas(alignment) std::byte bytes[size];  // NOLINT(modernize-avoid-c-arrays): no zeros
    /// For a hierarchy that tells more of the elements of another one. Not kept in lists.
    std::uint32_t mark;
};

namespace detail {

/// Whether elements of this type lie in the handle itself.
template <class Element>
inline constexpr bool fits_handle = std::is_trivially_copyable_v<Element> &&
                                    sizeof(Element) <= Handle::size &&
                                    alignof(Element) <= Handle::alignment;

/// Makes a handle of an element. An element that does not fit must outlive the handle.
template <class Element>
void set_handle(Handle& handle, const Element& element) {
    handle.mark = 0;
    if constexpr (fits_handle<Element>) {
        std::memcpy(handle.bytes, &element, sizeof(Element));
    } else {
        const Element* const at = &element;
        std::memcpy(handle.bytes, &at, sizeof(const void*));
    }
}

/// The element that a handle stands for.
/// \tparam Element the type it was made of
template <class Element>
const Element& element_of(const Handle& handle) {
    if constexpr (fits_handle<Element>) {
        return *std::launder(reinterpret_cast<const Element*>(handle.bytes));
    } else {
        const Element* at;
        std::memcpy(&at, handle.bytes, sizeof(const void*));
        return *at;
    }
}

/// A type of elements, told apart without std::type_info, which -fno-rtti takes away.
struct ElementType {
    const void* mark;       ///< one address a type, and one more where a library hides its own
    std::string_view name;  ///< the same in all libraries, unless it is anonymous

    friend bool operator==(const ElementType& a, const ElementType& b) {
        return a.mark == b.mark ||
               (a.name == b.name && a.name.find("anonymous") == std::string_view::npos);
    }
};

template <class Element>
inline constexpr char element_mark{};

template <class Element>
ElementType element_type() {
    return {&element_mark<Element>, std::string_view(__PRETTY_FUNCTION__)};
}

/// A vector of elements of one type.
class ElementVector {
public:
    virtual ~ElementVector() = default;
    virtual std::unique_ptr<ElementVector> clone() const = 0;
    virtual void append(const Handle& element) = 0;
    virtual void append(const ElementVector& same_type) = 0;
    virtual Handle handle(std::size_t i) const = 0;
    virtual std::size_t size() const = 0;
    virtual void clear() = 0;
    virtual std::size_t memory_bytes() const = 0;
    virtual ElementType type() const = 0;
    virtual const void* data() const = 0;
};

template <class Element>
class ElementVectorOf final : public ElementVector {
public:
    std::unique_ptr<ElementVector> clone() const override {
        return std::make_unique<ElementVectorOf>(*this);
    }
    void append(const Handle& element) override {
        elements_.push_back(element_of<Element>(element));
    }
    void append(const ElementVector& same_type) override {
        const auto& from = static_cast<const ElementVectorOf&>(same_type).elements_;
        elements_.insert(elements_.end(), from.begin(), from.end());
    }
    Handle handle(std::size_t i) const override {
        Handle result;
        set_handle(result, elements_[i]);
        return result;
    }
    std::size_t size() const override { return elements_.size(); }
    void clear() override { elements_.clear(); }
    std::size_t memory_bytes() const override { return elements_.capacity() * sizeof(Element); }
    ElementType type() const override { return element_type<Element>(); }
    const void* data() const override { return elements_.data(); }

private:
    std::vector<Element> elements_;
};

}  // namespace detail

/// A list of elements of one grid. It is a value; as<Element>() gives the elements.
class Elements {
public:
    /// An empty list that takes no element until an empty list of a grid is assigned to it.
    Elements() = default;
    Elements(const Elements& other) : all_{other.all_ ? other.all_->clone() : nullptr} {}
    Elements(Elements&&) noexcept = default;
    Elements& operator=(const Elements& other) {
        if (this != &other) all_ = other.all_ ? other.all_->clone() : nullptr;
        return *this;
    }
    Elements& operator=(Elements&&) noexcept = default;
    ~Elements() = default;

    /// An empty list for elements of one type.
    template <class Element>
    static Elements of() {
        Elements result;
        result.all_ = std::make_unique<detail::ElementVectorOf<Element>>();
        return result;
    }

    std::size_t size() const { return all_ ? all_->size() : 0; }
    bool empty() const { return size() == 0; }

    /// The elements, in the order they were added.
    /// \tparam Element the grid's
    /// \throw InvalidInput where the list holds elements of another type
    template <class Element>
    std::span<const Element> as() const {
        if (!all_ || all_->size() == 0) return {};
        if (all_->type() != detail::element_type<Element>()) {
            throw InvalidInput("the elements in the list are of another type than asked for");
        }
        return {static_cast<const Element*>(all_->data()), all_->size()};
    }

    void append(const Handle& element) { all_->append(element); }
    /// Appends a list of the same grid.
    void append(const Elements& other) {
        if (other.empty()) return;
        if (!all_) {
            *this = other;
        } else {
            all_->append(*other.all_);
        }
    }
    /// A handle of element i, valid until the list changes.
    Handle handle(std::size_t i) const { return all_->handle(i); }
    /// Empties the list and keeps its memory.
    void clear() {
        if (all_) all_->clear();
    }
    std::size_t memory_bytes() const { return all_ ? all_->memory_bytes() : 0; }

private:
    std::unique_ptr<detail::ElementVector> all_;
};

}  // namespace nestgrid
