"""How an ArduCopter flies the modes that it flies in its own way, one small class each, over the shared moves."""
