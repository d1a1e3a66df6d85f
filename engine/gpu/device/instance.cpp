#include "engine/gpu/device/instance.h"

#include <algorithm>
#include <cstring>
#include <mutex>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

#include "engine/core/log.h"
#include "engine/gpu/device/gpu_check.h"
#include "engine/gpu/device/vk_struct.h"

namespace skerry::gpu {
namespace {

// volk's function table is the process's. Instances nest (`devices` listed while a window runs), so
// the table goes back to the instance before when one ends. Creation and destruction happen on the
// main thread.
std::vector<VkInstance> g_instances;

void load_functions_of(VkInstance instance) {
  g_instances.push_back(instance);
  volkLoadInstance(instance);
}

void forget_functions_of(VkInstance instance) {
  std::erase(g_instances, instance);
  if (!g_instances.empty() && volkGetLoadedInstance() == instance)
    volkLoadInstance(g_instances.back());
}

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

std::vector<VkExtensionProperties> instance_extensions(const char* layer) {
  std::uint32_t count = 0;
  if (vkEnumerateInstanceExtensionProperties(layer, &count, nullptr) != VK_SUCCESS) return {};
  std::vector<VkExtensionProperties> list(count);
  if (vkEnumerateInstanceExtensionProperties(layer, &count, list.data()) < 0) return {};
  list.resize(count);
  return list;
}

bool contains(const std::vector<VkExtensionProperties>& list, const char* name) {
  return std::any_of(list.begin(), list.end(), [&](const VkExtensionProperties& extension) {
    return std::strcmp(extension.extensionName, name) == 0;
  });
}

bool has_validation_layer() {
  std::uint32_t count = 0;
  vkEnumerateInstanceLayerProperties(&count, nullptr);
  std::vector<VkLayerProperties> layers(count);
  vkEnumerateInstanceLayerProperties(&count, layers.data());
  layers.resize(count);
  return std::any_of(layers.begin(), layers.end(), [](const VkLayerProperties& layer) {
    return std::strcmp(layer.layerName, kValidationLayer) == 0;
  });
}

Result<void> check_loader() {
  if (volkInitialize() != VK_SUCCESS) {
    return Error{
        "cannot load libvulkan.so.1: there is no Vulkan loader; install the package libvulkan1 and "
        "a driver "
        "(mesa-vulkan-drivers)"};
  }
  if (volkGetInstanceVersion() < VK_API_VERSION_1_3) {
    return Error{"the Vulkan loader is older than 1.3: update the package libvulkan1"};
  }
  return {};
}

}  // namespace

// Messages may arrive from any thread that calls Vulkan.
struct Instance::Messages {
  std::mutex mutex;
  int count = 0;
  std::unordered_set<std::string> printed;
};

VkBool32 VKAPI_PTR Instance::on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                        VkDebugUtilsMessageTypeFlagsEXT types,
                                        const VkDebugUtilsMessengerCallbackDataEXT* data,
                                        void* user) {
  // General messages are the loader's own (a driver file without its card, for one) and say nothing
  // about our calls.
  if (types == VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT) return VK_FALSE;
  auto& messages = *static_cast<Messages*>(user);
  std::lock_guard lock(messages.mutex);
  ++messages.count;
  if (messages.printed.insert(data->pMessage).second) {
    const bool error = (severity & VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT) != 0;
    log_error(std::string("validation ") + (error ? "error: " : "warning: ") + data->pMessage);
  }
  return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT Instance::messenger_info() const {
  auto info = vk_struct<VkDebugUtilsMessengerCreateInfoEXT>(
      VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT);
  info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                         VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT |
                     VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
                     VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
  info.pfnUserCallback = &Instance::on_message;
  info.pUserData = messages_.get();
  return info;
}

Result<Instance> Instance::create(Validation validation,
                                  std::span<const char* const> surface_extensions) {
  const bool validate = validation != Validation::kOff;
  if (Result<void> loader = check_loader(); !loader) return loader.error();
  std::vector<const char*> extensions(surface_extensions.begin(), surface_extensions.end());
  const std::vector<VkExtensionProperties> available = instance_extensions(nullptr);
  for (const char* wanted : extensions) {
    if (!contains(available, wanted)) {
      return Error{std::string("cannot present to a window: the Vulkan instance lacks ") + wanted +
                   "; install a driver for this display, or use `skerry shot`"};
    }
  }
  // Names and labels are for debuggers too, so they do not depend on the validation layer.
  if (contains(available, VK_EXT_DEBUG_UTILS_EXTENSION_NAME))
    extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  if (validate) {
    if (!has_validation_layer() || !contains(instance_extensions(kValidationLayer),
                                             VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME)) {
      return Error{std::string("cannot validate: the layer ") + kValidationLayer +
                   " is not installed; install the package vulkan-validationlayers"};
    }
    extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
  }

  Instance instance;
  instance.messages_ = std::make_unique<Messages>();
  VkDebugUtilsMessengerCreateInfoEXT messenger = instance.messenger_info();
  const VkValidationFeatureEnableEXT enabled =
      VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
  auto features = vk_struct<VkValidationFeaturesEXT>(VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT);
  features.enabledValidationFeatureCount = 1;
  features.pEnabledValidationFeatures = &enabled;
  const VkValidationFeatureDisableEXT disabled = VK_VALIDATION_FEATURE_DISABLE_CORE_CHECKS_EXT;
  if (validation == Validation::kSynchronization) {
    features.disabledValidationFeatureCount = 1;
    features.pDisabledValidationFeatures = &disabled;
  }
  features.pNext = &messenger;
  auto application = vk_struct<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
  application.pApplicationName = "Skerry";
  application.pEngineName = "Skerry";
  application.apiVersion = VK_API_VERSION_1_3;
  auto info = vk_struct<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
  info.pNext = validate ? &features : nullptr;
  info.pApplicationInfo = &application;
  info.enabledLayerCount = validate ? 1u : 0u;
  info.ppEnabledLayerNames = &kValidationLayer;
  info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  const VkResult created = vkCreateInstance(&info, nullptr, &instance.handle_);
  if (created != VK_SUCCESS) {
    return Error{"cannot start Vulkan: vkCreateInstance returned " + result_name(created) +
                 "; install a Vulkan driver (mesa-vulkan-drivers has a software one)"};
  }
  load_functions_of(instance.handle_);
  if (validate) {
    GPU_CHECK(vkCreateDebugUtilsMessengerEXT(instance.handle_, &messenger, nullptr,
                                             &instance.messenger_));
  }
  return instance;
}

Instance::Instance(Instance&& other) noexcept
    : handle_(std::exchange(other.handle_, VK_NULL_HANDLE)),
      messenger_(std::exchange(other.messenger_, VK_NULL_HANDLE)),
      messages_(std::move(other.messages_)) {}

Instance::~Instance() {
  if (messenger_) vkDestroyDebugUtilsMessengerEXT(handle_, messenger_, nullptr);
  if (handle_) {
    vkDestroyInstance(handle_, nullptr);
    forget_functions_of(handle_);
  }
}

int Instance::message_count() const {
  std::lock_guard lock(messages_->mutex);
  return messages_->count;
}

Result<std::vector<VkPhysicalDevice>> Instance::devices() const {
  std::uint32_t count = 0;
  VkResult result = vkEnumeratePhysicalDevices(handle_, &count, nullptr);
  std::vector<VkPhysicalDevice> list(count);
  if (result == VK_SUCCESS && count > 0)
    result = vkEnumeratePhysicalDevices(handle_, &count, list.data());
  list.resize(count);
  if (result < 0 || list.empty()) {
    return Error{
        "no Vulkan device: no driver reports one; install a Vulkan driver (mesa-vulkan-drivers has "
        "a "
        "software one)"};
  }
  return list;
}

}  // namespace skerry::gpu
