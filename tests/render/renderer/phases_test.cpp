// The order of a frame's phases is a matter of types: what is wrong does not compile. Each check
// below is one wrong program; there is nothing left to run.
#include "engine/render/frame/phases.h"

#include <type_traits>

#include "engine/render/light/shadow_pass.h"
#include "engine/render/post/develop_pass.h"
#include "engine/render/scene/geometry_pass.h"
#include "engine/render/surface/media_light.h"
#include "engine/render/surface/shade_pass.h"

namespace skerry::render {
namespace {

template <class T>
constexpr bool kOnlyHandedOn =
    !std::is_default_constructible_v<T> && !std::is_copy_constructible_v<T> &&
    !std::is_copy_assignable_v<T> && std::is_nothrow_move_constructible_v<T> &&
    std::is_nothrow_move_assignable_v<T>;
static_assert(kOnlyHandedOn<Geometry> && kOnlyHandedOn<Shadows> && kOnlyHandedOn<Shaded> &&
              kOnlyHandedOn<Developed>);

// Nobody but the passes makes a phase out of images.
static_assert(!std::is_constructible_v<Geometry, gpu::ImageRef, gpu::ImageRef>);
static_assert(!std::is_constructible_v<Shadows, gpu::ImageRef>);
static_assert(!std::is_constructible_v<Shaded, gpu::ImageRef>);
static_assert(!std::is_constructible_v<Developed, gpu::ImageRef>);

// No phase passes for another.
template <class To, class... From>
constexpr bool kNotMadeFrom = (!std::is_constructible_v<To, From> && ...) &&
                              (!std::is_constructible_v<To, const From&> && ...) &&
                              (!std::is_assignable_v<To&, From> && ...);
static_assert(kNotMadeFrom<Geometry, Shadows, Shaded, Developed>);
static_assert(kNotMadeFrom<Shadows, Geometry, Shaded, Developed>);
static_assert(kNotMadeFrom<Shaded, Geometry, Shadows, Developed>);
static_assert(kNotMadeFrom<Developed, Geometry, Shadows, Shaded>);

// Shading needs geometry and shadows; sampling a phase that was not written has no type to name.
using Layers = TranslucentPass::Layers;
template <class... Inputs>
constexpr bool kShades = requires(Inputs... inputs) {
  ShadedFrom{inputs...};
};
static_assert(kShades<const Geometry&, const Shadows&, const Layers&>);
static_assert(!kShades<const Shadows&, const Geometry&, const Layers&>);
static_assert(!kShades<const Geometry&>);
static_assert(!kShades<const Shaded&, const Shadows&, const Layers&>);

// Translucent surfaces and development use a picture up: only a phase that is given away will do.
template <class Input>
constexpr bool kDevelops =
    std::is_invocable_v<decltype(&DevelopPass::add), gpu::FrameGraph&, gpu::Pipelines&, SceneRefs&,
                        Input, const Bloom*, gpu::Image&>;
static_assert(kDevelops<Shaded>);
static_assert(!kDevelops<Shaded&> && !kDevelops<const Shaded&>, "developed twice");
static_assert(!kDevelops<Geometry> && !kDevelops<Developed> && !kDevelops<gpu::ImageRef>);

template <class Input>
constexpr bool kLooksThrough =
    std::is_invocable_v<decltype(&TranslucentPass::add), gpu::FrameGraph&, gpu::Pipelines&,
                        SceneRefs&, const TranslucentPass::In&, Input>;
static_assert(kLooksThrough<Shaded>);
static_assert(!kLooksThrough<Shaded&> && !kLooksThrough<const Shaded&>, "drawn over twice");
static_assert(!kLooksThrough<Developed>, "translucent surfaces after the tone curve");

}  // namespace
}  // namespace skerry::render
