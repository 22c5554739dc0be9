# tests of proxy
foreach(topic kernel curvature sample density mask wall pair patch contacts update transfer viscous input)
  byssus_test(unit/proxy/test_${topic} base sph proxy)
endforeach()
byssus_test(unit/surface/test_surface base)
