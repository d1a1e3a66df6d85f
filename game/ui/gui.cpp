#include "game/ui/gui.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cfloat>
#include <utility>

#include "game/ui/look.h"
#include "game/ui/pictures.h"
#include "game/words/words.h"

namespace skerry::game::ui {

/// ImGui asks for the clipboard through plain functions.
struct ClipboardCalls {
  static const char* read(void* user) {
    Gui& gui = *static_cast<Gui*>(user);
    if (gui.clipboard_.read) gui.clipboard_text_ = gui.clipboard_.read();
    gui.clipboard_text_ = pasted_text(gui.clipboard_text_, std::string::npos);
    gui.fonts_.want(gui.clipboard_text_.substr(0, paste_room()));
    gui.refused_ = gui.clipboard_text_.size() > paste_room();
    return gui.refused_ ? "" : gui.clipboard_text_.c_str();
  }
  static void write(void* user, const char* text) {
    Gui& gui = *static_cast<Gui*>(user);
    gui.clipboard_text_ = text;
    if (gui.clipboard_.write) gui.clipboard_.write(gui.clipboard_text_);
  }
};

namespace {

/// ImGui's indexed lists as plain triangles, each with its clip rectangle's index.
OverlayTriangles flatten(const ImDrawData& data) {
  OverlayTriangles out;
  for (int l = 0; l < data.CmdListsCount; ++l) {
    const ImDrawList& list = *data.CmdLists[l];
    for (const ImDrawCmd& command : list.CmdBuffer) {
      const bool picture = command.GetTexID() == pictures_id();
      const auto clip =
          static_cast<std::uint32_t>(out.clips.size()) | (picture ? shared::kOverlayPicture : 0u);
      out.clips.emplace_back(command.ClipRect.x, command.ClipRect.y, command.ClipRect.z,
                             command.ClipRect.w);
      for (unsigned i = 0; i < command.ElemCount; ++i) {
        const ImDrawIdx index = list.IdxBuffer[static_cast<int>(command.IdxOffset + i)];
        const ImDrawVert& v = list.VtxBuffer[static_cast<int>(command.VtxOffset + index)];
        out.vertices.push_back({{v.pos.x, v.pos.y}, {v.uv.x, v.uv.y}, v.col, clip});
      }
    }
  }
  return out;
}

ImGuiContext* make_context() {
  IMGUI_CHECKVERSION();
  ImGuiContext* context = ImGui::CreateContext();
  ImGui::SetCurrentContext(context);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // the working directory is not ours to write to
  io.LogFilename = nullptr;
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset | ImGuiBackendFlags_HasGamepad;
  io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard | ImGuiConfigFlags_NavEnableGamepad |
                    ImGuiConfigFlags_NoMouseCursorChange;
  io.ConfigWindowsMoveFromTitleBarOnly = true;
  return context;
}

}  // namespace

std::string pasted_text(std::string_view text, std::size_t max_bytes) {
  text = text.substr(0, text.find_first_of(std::string_view("\r\n\0", 3)));
  if (text.size() <= max_bytes) return std::string(text);
  std::size_t end = max_bytes;
  // Bytes of the form 10xxxxxx go on with a character of UTF-8.
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
  return std::string(text.substr(0, end));
}

Gui::Gui(Clipboard clipboard) : context_(make_context()), clipboard_(std::move(clipboard)) {
  ImGuiIO& io = ImGui::GetIO();
  io.ClipboardUserData = this;
  io.GetClipboardTextFn = ClipboardCalls::read;
  io.SetClipboardTextFn = ClipboardCalls::write;
  release_all();  // ImGui needs the state of its keys before the first frame
}

Gui::~Gui() {
  ImGui::DestroyContext(context_);
}

FontAtlas Gui::font() const {
  ImGui::SetCurrentContext(context_);
  unsigned char* texels = nullptr;
  FontAtlas atlas;
  ImGui::GetIO().Fonts->GetTexDataAsAlpha8(&texels, &atlas.width, &atlas.height);
  atlas.texels = {texels,
                  static_cast<std::size_t>(atlas.width) * static_cast<std::size_t>(atlas.height)};
  return atlas;
}

void Gui::expect(const platform::InputFrame& input) {
  for (const platform::InputEvent& event : input.events) fonts_.want(event.character);
}

bool Gui::fit_font() {
  ImGui::SetCurrentContext(context_);
  return fonts_.fit();
}

void Gui::begin(const GuiFrame& frame) {
  (void)font();  // NewFrame wants the atlas built
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = ImVec2(static_cast<float>(frame.width), static_cast<float>(frame.height));
  io.DeltaTime = std::max(static_cast<float>(frame.seconds), 1e-6f);
  if (!pressed_) scale_ = frame.scale;
  begin_look(fonts_, io.DisplaySize.x, io.DisplaySize.y, scale_);
  if (frame.between)
    rest_ = kFramesOfFocus;  // the screens come anew
  else if (frame.input)
    feed(*frame.input);
  else if (fed_)
    release_all();
  if (!frame.between) fed_ = frame.input != nullptr;
  ImGui::NewFrame();
}

OverlayTriangles Gui::end() {
  pressed_ = ImGui::IsAnyItemActive();
  ImGui::Render();
  return flatten(*ImGui::GetDrawData());
}

std::string Gui::take_refusal() {
  if (!std::exchange(refused_, false)) return {};
  return tr_format("Not pasted: a text of {} bytes is too long here", clipboard_text_.size());
}

bool Gui::typing() const {
  ImGui::SetCurrentContext(context_);
  return ImGui::GetIO().WantTextInput;
}

}  // namespace skerry::game::ui
