#include "game/sound/openal_out.h"

#include <AL/al.h>
#include <AL/alc.h>
#include <dlfcn.h>

#include <array>
#include <vector>

#include "game/sound/sound_names.h"

namespace skerry::game {

/// OpenAL's functions and objects.
struct OpenAlOut::Calls {
  void* library = nullptr;
  LPALCOPENDEVICE open_device = nullptr;
  LPALCCLOSEDEVICE close_device = nullptr;
  LPALCCREATECONTEXT create_context = nullptr;
  LPALCDESTROYCONTEXT destroy_context = nullptr;
  LPALCMAKECONTEXTCURRENT make_current = nullptr;
  LPALGENSOURCES gen_sources = nullptr;
  LPALDELETESOURCES delete_sources = nullptr;
  LPALGENBUFFERS gen_buffers = nullptr;
  LPALDELETEBUFFERS delete_buffers = nullptr;
  LPALBUFFERDATA buffer_data = nullptr;
  LPALSOURCEQUEUEBUFFERS queue_buffers = nullptr;
  LPALSOURCEUNQUEUEBUFFERS unqueue_buffers = nullptr;
  LPALGETSOURCEI get_source = nullptr;
  LPALSOURCEPLAY play_source = nullptr;
  LPALSOURCESTOP stop_source = nullptr;
  LPALGETERROR get_error = nullptr;

  ALCdevice* device = nullptr;
  ALCcontext* context = nullptr;
  ALuint source = 0;
  std::array<ALuint, kBlocks> buffers{};
  std::vector<ALuint> spare;

  template <class Function>
  bool find(Function& function, const char* name) {
    function = reinterpret_cast<Function>(dlsym(library, name));
    return function != nullptr;
  }
  bool load();
  bool make_source();
};

namespace {

/// libasound writes to stderr about every card that it does not find. OpenAL may load it only when
/// a device is opened, so it is loaded here, and stays.
void be_silent(const char*, int, const char*, int, const char*, ...) {}
void silence_alsa() {
  void* alsa = dlopen("libasound.so.2", RTLD_NOW | RTLD_LOCAL);
  if (!alsa) return;
  using Handler = void (*)(const char*, int, const char*, int, const char*, ...);
  using SetHandler = int (*)(Handler);
  if (const auto set = reinterpret_cast<SetHandler>(dlsym(alsa, "snd_lib_error_set_handler")))
    set(be_silent);
}

}  // namespace

bool OpenAlOut::Calls::load() {
  library = dlopen("libopenal.so.1", RTLD_NOW | RTLD_LOCAL);
  if (!library) return false;
  silence_alsa();
  return find(open_device, "alcOpenDevice") && find(close_device, "alcCloseDevice") &&
         find(create_context, "alcCreateContext") && find(destroy_context, "alcDestroyContext") &&
         find(make_current, "alcMakeContextCurrent") && find(gen_sources, "alGenSources") &&
         find(delete_sources, "alDeleteSources") && find(gen_buffers, "alGenBuffers") &&
         find(delete_buffers, "alDeleteBuffers") && find(buffer_data, "alBufferData") &&
         find(queue_buffers, "alSourceQueueBuffers") &&
         find(unqueue_buffers, "alSourceUnqueueBuffers") && find(get_source, "alGetSourcei") &&
         find(play_source, "alSourcePlay") && find(stop_source, "alSourceStop") &&
         find(get_error, "alGetError");
}

bool OpenAlOut::Calls::make_source() {
  gen_sources(1, &source);
  gen_buffers(kBlocks, buffers.data());
  if (get_error() != AL_NO_ERROR) return false;
  spare.assign(buffers.begin(), buffers.end());
  return true;
}

OpenAlOut::OpenAlOut() : al_(std::make_unique<Calls>()) {}

Result<std::unique_ptr<OpenAlOut>> OpenAlOut::open() {
  std::unique_ptr<OpenAlOut> out(new OpenAlOut());
  Calls& al = *out->al_;
  if (!al.load())
    return Error{"no sound: libopenal.so.1 cannot be loaded; install the package libopenal1"};
  al.device = al.open_device(nullptr);
  if (!al.device) return Error{"no sound: there is no device; plug one in and start again"};
  const ALCint wanted[] = {ALC_FREQUENCY, kSampleRate, 0};
  al.context = al.create_context(al.device, wanted);
  if (!al.context || !al.make_current(al.context) || !al.make_source())
    return Error{"no sound: the device takes no stream; choose another one and start again"};
  return out;
}

OpenAlOut::~OpenAlOut() {
  Calls& al = *al_;
  if (al.context) {
    if (!al.spare.empty() || al.source != 0) {
      al.stop_source(al.source);
      al.delete_sources(1, &al.source);
      al.delete_buffers(kBlocks, al.buffers.data());
    }
    al.make_current(nullptr);
    al.destroy_context(al.context);
  }
  if (al.device) al.close_device(al.device);
  // The library stays: its threads' last instructions lie in it.
}

int OpenAlOut::room() {
  Calls& al = *al_;
  ALint done = 0;
  al.get_source(al.source, AL_BUFFERS_PROCESSED, &done);
  for (; done > 0; --done) {
    ALuint buffer = 0;
    al.unqueue_buffers(al.source, 1, &buffer);
    if (al.get_error() != AL_NO_ERROR) break;
    al.spare.push_back(buffer);
  }
  return static_cast<int>(al.spare.size());
}

void OpenAlOut::play(std::span<const std::int16_t> stereo) {
  Calls& al = *al_;
  const ALuint buffer = al.spare.back();
  al.spare.pop_back();
  al.buffer_data(buffer, AL_FORMAT_STEREO16, stereo.data(),
                 static_cast<ALsizei>(stereo.size_bytes()), kSampleRate);
  al.queue_buffers(al.source, 1, &buffer);
  ALint state = 0;
  al.get_source(al.source, AL_SOURCE_STATE, &state);
  if (state != AL_PLAYING) al.play_source(al.source);  // begins, or goes on after it ran dry
}

}  // namespace skerry::game
