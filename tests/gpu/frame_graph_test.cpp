// The frame graph without a device: what runs, in which order, with which barriers.
#include "engine/gpu/graph/frame_graph.h"

#include <gtest/gtest.h>

#include "engine/gpu/device/device.h"
#include "engine/gpu/device/resources.h"

namespace skerry::gpu {
namespace {

using Names = std::vector<std::string>;

ImageDesc picture(std::string name, std::uint32_t layers = 1) {
  ImageDesc desc;
  desc.name = std::move(name);
  desc.format = VK_FORMAT_R8G8B8A8_UNORM;
  desc.extent = {64, 32};
  desc.layers = layers;
  return desc;
}

BufferDesc bytes(std::string name) {
  return {std::move(name), 256, 0, Memory::kDevice};
}

void nothing(Commands&) {}

/// A graph and short words for passes of one read or write.
struct Frame {
  FrameGraph graph{nullptr};
  Frame() { graph.begin(); }
  void run() {
    graph.compile();
    graph.execute(VK_NULL_HANDLE, 0);
  }
  template <class Ref>
  Ref writes(const std::string& name, Ref to, Use use = Use::kComputeWrite) {
    Ref out;
    graph.add_pass(
        name, [&](PassBuilder& b) { out = b.write(to, use); }, nothing);
    return out;
  }
  template <class Ref>
  void reads(const std::string& name, Ref from, Use use) {
    graph.add_pass(
        name,
        [&](PassBuilder& b) {
          b.read(from, use);
          b.keep();
        },
        nothing);
  }
  ImageRef draws_layer(const std::string& name, ImageRef to, std::uint32_t layer) {
    ImageRef out;
    graph.add_pass(
        name, [&](PassBuilder& b) { out = b.depth(to, Load::cleared({}), layer); }, nothing);
    return out;
  }
};

TEST(FrameGraph, APassWhoseResultNobodyReadsIsLeftOutAndItsImageNotMade) {
  Frame frame;
  frame.writes("lonely", frame.graph.create(picture("unseen")));
  frame.reads("show", frame.writes("draw", frame.graph.create(picture("seen"))), Use::kComputeRead);
  frame.run();
  EXPECT_EQ(frame.graph.pass_names(), (Names{"draw", "show"}));
  EXPECT_EQ(frame.graph.culled_names(), Names{"lonely"});
  ASSERT_EQ(frame.graph.transient_memory().size(), 1u);
  EXPECT_EQ(frame.graph.transient_memory()[0].name, "seen");
}

TEST(FrameGraph, WhatIsLeftOutIsNotCounted) {
  Frame frame;
  frame.writes("lonely", frame.graph.create(picture("unseen")));
  const ImageRef seen = frame.writes("draw", frame.graph.create(picture("seen")));
  const BufferRef words = frame.writes("fill", frame.graph.create(bytes("words")));
  frame.reads("show", seen, Use::kComputeRead);
  frame.reads("copy", words, Use::kTransferRead);
  frame.run();
  const FrameCounts counts = frame.graph.counts();
  EXPECT_EQ(counts.passes, 4u);
  EXPECT_EQ(counts.images, 1u);
  EXPECT_EQ(counts.buffers, 1u);
  // The image's way into a layout, and what each reader waits for.
  EXPECT_EQ(counts.barriers, 3u);
  EXPECT_EQ(counts.dispatches + counts.draws + counts.copies + counts.render_passes, 0u);
  frame.graph.begin();
  EXPECT_EQ(frame.graph.counts(), FrameCounts{});
}

TEST(FrameGraph, AChainIsLeftOutFromItsUnreadEnd) {
  Frame frame;
  const ImageRef first = frame.writes("a", frame.graph.create(picture("a")));
  ImageRef second = frame.graph.create(picture("b"));
  frame.graph.add_pass(
      "b",
      [&](PassBuilder& b) {
        b.read(first, Use::kComputeRead);
        second = b.write(second, Use::kComputeWrite);
      },
      nothing);
  frame.run();
  EXPECT_EQ(frame.graph.culled_names(), (Names{"a", "b"}));
}

TEST(FrameGraph, APassThatWritesAnImportedResourceStays) {
  Frame frame;
  Buffer kept;
  frame.writes("count", frame.graph.import(kept));
  frame.run();
  EXPECT_EQ(frame.graph.pass_names(), Names{"count"});
}

TEST(FrameGraph, PassesRunInTheOrderTheyWereAdded) {
  Frame frame;
  Buffer shared;
  BufferRef ref = frame.graph.import(shared);
  Names recorded;
  for (const char* name : {"c", "a", "b"}) {
    frame.graph.add_pass(
        name, [&](PassBuilder& b) { ref = b.write(ref, Use::kComputeWrite); },
        [&recorded, name](Commands&) { recorded.emplace_back(name); });
  }
  frame.run();
  EXPECT_EQ(recorded, (Names{"c", "a", "b"}));
}

TEST(FrameGraph, AnEarlierWriteStaysWhenALaterOneOnlyAddsToIt) {
  Frame frame;
  const ImageRef first = frame.writes("first", frame.graph.create(picture("p")));
  frame.reads("show", frame.writes("second", first), Use::kComputeRead);
  frame.run();
  EXPECT_EQ(frame.graph.pass_names(), (Names{"first", "second", "show"}));
}

TEST(FrameGraph, AnAttachmentThatKeepsNothingForgetsTheWriteBefore) {
  for (const Load load : {Load::cleared({}), Load::discarded()}) {
    Frame frame;
    const ImageRef first = frame.writes("forgotten", frame.graph.create(picture("p")));
    ImageRef second;
    frame.graph.add_pass(
        "draw", [&](PassBuilder& b) { second = b.color(first, load); }, nothing);
    frame.reads("show", second, Use::kFragmentRead);
    frame.run();
    EXPECT_EQ(frame.graph.culled_names(), Names{"forgotten"});
  }
}

TEST(FrameGraph, LayersOfOneImageChainAndShareOneTransition) {
  Frame frame;
  ImageRef map = frame.graph.create(picture("shadow", 4));
  for (std::uint32_t i = 0; i < 4; ++i)
    map = frame.draws_layer("shadow_" + std::to_string(i), map, i);
  frame.reads("light", map, Use::kComputeSampled);
  frame.run();
  EXPECT_EQ(frame.graph.pass_names().size(), 5u);
  // One transition to attachment before the first layer, one to sampled after the last.
  EXPECT_EQ(frame.graph.counts().barriers, 2u);
}

TEST(FrameGraph, DrawingALayerAgainWaitsForTheFirstTime) {
  Frame frame;
  ImageRef map = frame.graph.create(picture("shadow", 2));
  map = frame.draws_layer("a", map, 0);
  map = frame.draws_layer("b", map, 1);
  map = frame.draws_layer("c", map, 1);
  frame.reads("light", map, Use::kComputeSampled);
  frame.run();
  EXPECT_EQ(frame.graph.counts().barriers, 3u);
}

TEST(FrameGraph, ReadsAfterReadsInTheSameStageNeedNoBarrier) {
  Frame frame;
  const BufferRef data = frame.writes("write", frame.graph.create(bytes("data")));
  frame.reads("r0", data, Use::kComputeRead);
  frame.reads("r1", data, Use::kComputeRead);
  frame.reads("r2", data, Use::kComputeRead);
  frame.run();
  EXPECT_EQ(frame.graph.counts().barriers, 1u);
}

TEST(FrameGraph, AReadInAnotherStageMustSeeTheWriteToo) {
  Frame frame;
  const BufferRef data = frame.writes("write", frame.graph.create(bytes("data")));
  frame.reads("compute", data, Use::kComputeRead);
  frame.reads("vertex", data, Use::kVertexRead);
  frame.reads("both", data, Use::kComputeRead);
  frame.run();
  EXPECT_EQ(frame.graph.counts().barriers, 2u);
}

TEST(FrameGraph, AWriteAfterReadsWaits) {
  Frame frame;
  Buffer kept;
  BufferRef data = frame.graph.import(kept);
  frame.reads("read", data, Use::kIndirect);  // nobody before: nothing to wait for
  data = frame.writes("write", data);
  data = frame.writes("again", data);
  frame.run();
  EXPECT_EQ(frame.graph.counts().barriers, 2u);
}

TEST(FrameGraph, AFreshBufferNeedsNoBarrierAndAFreshImageOne) {
  Frame frame;
  Buffer buffer;
  Image image;
  frame.writes("buffer", frame.graph.import(buffer));
  frame.writes("image", frame.graph.import(image));
  frame.run();
  EXPECT_EQ(frame.graph.counts().barriers, 1u);
}

TEST(FrameGraph, TheCpuReadsAfterThePassThatWrites) {
  Frame frame;
  Buffer kept;
  const BufferRef ref = frame.graph.import(kept);
  frame.graph.add_pass(
      "count", [&](PassBuilder& b) { b.read(b.write(ref, Use::kComputeWrite), Use::kHostRead); },
      nothing);
  frame.run();
  EXPECT_EQ(frame.graph.counts().barriers, 1u);
  EXPECT_TRUE((kept.state.stages & VK_PIPELINE_STAGE_2_HOST_BIT) != 0);
  EXPECT_FALSE(kept.state.written);
}

TEST(FrameGraph, ImportedStateIsCarriedToTheNextFrame) {
  Frame frame;
  Image kept;
  frame.writes("write", frame.graph.import(kept));
  frame.run();
  EXPECT_EQ(kept.state.layout, VK_IMAGE_LAYOUT_GENERAL);
  EXPECT_TRUE(kept.state.written);

  frame.graph.begin();
  frame.reads("storage", frame.graph.import(kept), Use::kComputeRead);
  frame.run();
  EXPECT_EQ(frame.graph.counts().barriers, 1u)
      << "the write of the frame before must become visible";
  EXPECT_FALSE(kept.state.written);

  frame.graph.begin();
  frame.reads("storage", frame.graph.import(kept), Use::kComputeRead);
  frame.run();
  EXPECT_EQ(frame.graph.counts().barriers, 0u);
}

TEST(FrameGraph, BarriersFollowWhatHappenedAfterCompile) {
  Frame frame;
  Buffer kept;
  frame.reads("read", frame.graph.import(kept), Use::kComputeRead);
  frame.graph.compile();
  EXPECT_EQ(frame.graph.counts().barriers, 0u);
  kept.state.stages = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
  kept.state.access = VK_ACCESS_2_TRANSFER_WRITE_BIT;
  kept.state.written = true;
  frame.graph.execute(VK_NULL_HANDLE, 0);
  EXPECT_EQ(frame.graph.counts().barriers, 1u);
}

TEST(FrameGraph, ImportingTwiceGivesTheSameResourceAtItsNewestVersion) {
  Frame frame;
  Buffer kept;
  const BufferRef written = frame.writes("write", frame.graph.import(kept));
  const BufferRef again = frame.graph.import(kept);
  EXPECT_EQ(again.id, written.id);
  EXPECT_EQ(again.version, written.version);
}

TEST(FrameGraph, TransientsOfOneDescriptionAreReusedNextFrame) {
  Frame frame;
  const Image* seen[3] = {};
  for (const Image*& image : seen) {
    frame.graph.begin();
    ImageRef out;
    const ImageRef made = frame.graph.create(picture("p"));
    frame.graph.add_pass(
        "write", [&](PassBuilder& b) { out = b.write(made, Use::kComputeWrite); }, nothing);
    frame.graph.add_pass(
        "show",
        [&](PassBuilder& b) {
          b.read(out, Use::kComputeRead);
          b.keep();
        },
        [&](Commands& c) { image = &c.image(out); });
    frame.run();
  }
  EXPECT_EQ(seen[0], seen[1]);
  EXPECT_EQ(seen[0], seen[2]);
}

TEST(FrameGraph, TwoTransientsOfOneFrameAreNeverTheSame) {
  Frame frame;
  const ImageRef a = frame.writes("a", frame.graph.create(picture("p")));
  const ImageRef b = frame.writes("b", frame.graph.create(picture("p")));
  const Image *seen_a = nullptr, *seen_b = nullptr;
  frame.graph.add_pass(
      "show",
      [&](PassBuilder& builder) {
        builder.read(a, Use::kComputeRead);
        builder.read(b, Use::kComputeRead);
        builder.keep();
      },
      [&](Commands& c) {
        seen_a = &c.image(a);
        seen_b = &c.image(b);
      });
  frame.run();
  EXPECT_NE(seen_a, seen_b);
}

TEST(FrameGraph, LeftOutPassesKeepTheirReason) {
  Frame frame;
  frame.graph.leave_out("shadow_sun", "the sun is below the horizon");
  ASSERT_EQ(frame.graph.left_out().size(), 1u);
  EXPECT_EQ(frame.graph.left_out()[0].why, "the sun is below the horizon");
  frame.graph.begin();
  EXPECT_TRUE(frame.graph.left_out().empty());
}

using FrameGraphDeathTest = testing::Test;

TEST(FrameGraphDeathTest, AnOldVersionIsFatalAndNamesPassesAndImage) {
  Frame frame;
  const ImageRef old = frame.graph.create(picture("hdr"));
  frame.writes("shade", old);
  frame.reads("show", old, Use::kComputeRead);
  EXPECT_DEATH(frame.graph.compile(), "'show' uses 'hdr'.*'shade' wrote a newer version");
}

TEST(FrameGraphDeathTest, WritingAnOldVersionIsFatal) {
  Frame frame;
  const ImageRef old = frame.graph.create(picture("hdr"));
  frame.writes("one", old);
  frame.writes("two", old);
  EXPECT_DEATH(frame.graph.compile(), "'two' uses 'hdr'.*'one' wrote a newer version");
}

TEST(FrameGraphDeathTest, ReadingWhatNobodyWroteIsFatal) {
  Frame frame;
  frame.reads("show", frame.graph.create(picture("hdr")), Use::kComputeRead);
  EXPECT_DEATH(frame.graph.compile(), "'show' uses 'hdr', which no pass has written yet");
}

TEST(FrameGraphDeathTest, KeepingAnAttachmentNobodyWroteIsFatal) {
  Frame frame;
  const ImageRef fresh = frame.graph.create(picture("hdr"));
  frame.graph.add_pass(
      "draw", [&](PassBuilder& b) { std::ignore = b.color(fresh, Load::keep()); }, nothing);
  EXPECT_DEATH(frame.graph.compile(), "'draw' uses 'hdr', which no pass has written yet");
}

TEST(FrameGraphDeathTest, UsingWhatWasNotDeclaredIsFatal) {
  Frame frame;
  Buffer kept;
  const BufferRef hidden = frame.graph.create(bytes("secret"));
  const BufferRef ref = frame.graph.import(kept);
  frame.graph.add_pass(
      "sneaky", [&](PassBuilder& b) { std::ignore = b.write(ref, Use::kComputeWrite); },
      [&](Commands& c) { c.buffer(hidden); });
  frame.graph.compile();
  EXPECT_DEATH(frame.graph.execute(VK_NULL_HANDLE, 0),
               "'sneaky' uses 'secret', which it did not declare");
}

TEST(FrameGraphDeathTest, AnEmptyReferenceIsFatal) {
  Frame frame;
  EXPECT_DEATH(frame.reads("show", ImageRef{}, Use::kComputeRead),
               "'show' uses an empty reference");
}

TEST(FrameGraphDeathTest, AnAreaBeyondTheAttachmentsIsFatal) {
  for (const VkRect2D area : {VkRect2D{{-1, 0}, {4, 4}}, VkRect2D{{0, 29}, {4, 4}},
                              VkRect2D{{0, 0}, {0, 4}}, VkRect2D{{0, 1}, {4, ~0u}}}) {
    Frame frame;
    const ImageRef image = frame.graph.create(picture("image"));
    frame.graph.add_pass(
        "draw",
        [&](PassBuilder& builder) {
          builder.area(area);
          std::ignore = builder.color(image, Load::cleared({}));
        },
        nothing);
    EXPECT_DEATH(frame.graph.compile(),
                 "'draw' uses 'image', which does not contain the area that the pass draws to");
  }
}

TEST(FrameGraphDeathTest, AttachmentsOfDifferentSizesAreFatal) {
  Frame frame;
  ImageDesc small = picture("small");
  small.extent = {8, 8};
  const ImageRef a = frame.graph.create(picture("large")), b = frame.graph.create(small);
  frame.graph.add_pass(
      "draw",
      [&](PassBuilder& builder) {
        std::ignore = builder.color(a, Load::cleared({}));
        std::ignore = builder.color(b, Load::cleared({}));
      },
      nothing);
  EXPECT_DEATH(frame.graph.compile(),
               "'draw' uses 'small', which has another size than its attachment 'large'");
}

TEST(FrameGraphDeathTest, SamplingOnesOwnAttachmentIsFatal) {
  Frame frame;
  const ImageRef base = frame.writes("base", frame.graph.create(picture("hdr")));
  ImageRef out;
  frame.graph.add_pass(
      "loop",
      [&](PassBuilder& b) {
        b.read(base, Use::kFragmentRead);
        out = b.color(base, Load::keep());
        b.keep();
      },
      nothing);
  EXPECT_DEATH(frame.graph.compile(),
               "'loop' uses 'hdr', which is an attachment and used in another way");
}

}  // namespace
}  // namespace skerry::gpu
