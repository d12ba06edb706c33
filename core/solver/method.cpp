#include "core/solver/method.h"

#include <array>
#include <cassert>

#include "core/solver/soft_step.h"

namespace huestep {

namespace {

/// Place i: the method whose number is i.
constexpr std::array methods{
    MethodTraits{Method::SoftStep, "soft-step",
                 "coloured Gauss-Seidel with soft rows and substeps: the product", solveSoftStep,
                 true, true, true},
    MethodTraits{Method::Sequential, "sequential",
                 "the same in key order, one constraint after another", solveSoftStep, false, false,
                 true},
};

}  // namespace

std::span<const MethodTraits> allMethods() {
    return methods;
}

const MethodTraits& traitsOf(Method method) {
    const auto place = static_cast<std::size_t>(method);
    assert(place < methods.size());
    assert(methods[place].method == method);
    return methods[place];
}

std::optional<Method> methodNamed(std::string_view name) {
    for (const MethodTraits& m : methods) {
        if (m.name == name) return m.method;
    }
    return std::nullopt;
}

}  // namespace huestep
