# tests of base
byssus_test(unit/scene/test_keys base)
byssus_test(unit/scene/test_scene base)
byssus_test(unit/scene/test_scene_errors base)
byssus_test(unit/scene/test_array base)
